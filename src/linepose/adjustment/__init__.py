"""The adjustment: our estimator."""
