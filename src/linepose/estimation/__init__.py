"""What serves every noise model: optimisers, outlier removal, sampling, diagnostics."""
