"""The trajectory types under the name by which planning knows them; they live below the emergency check, which needs them and no planning."""

from regdb_runtime.trajectory import Candidates, Floats, FrenetState, Trajectory

__all__ = ["Candidates", "Floats", "FrenetState", "Trajectory"]
