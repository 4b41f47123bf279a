"""What was measured: observations of points, the navigation system's poses and covariances, data sets."""
