"""Planning: from a manoeuvre and what binds it to trajectories, their limits, contacts and costs, and the one to drive."""
