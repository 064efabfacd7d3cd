"""Assessment: what candidate trajectories do, in the words of the law, and what the law says to that."""
