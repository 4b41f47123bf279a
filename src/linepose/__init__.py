"""linepose: the pose of a line-scan camera on a vehicle, and how sure it is."""
