"""Vector maps: the road map's own type, its readers, Frenet coordinates along a path, and routes."""
