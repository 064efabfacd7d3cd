"""Observer mode (paper, section IV-C): recorded drives judged by perception and strategy, without motion planning."""
