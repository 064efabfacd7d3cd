"""SUMO as a world: its traffic drives on our road map, our planner drives the ego."""
