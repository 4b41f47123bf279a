"""What a survey looks at: targets of several kinds, one a file, and the registry of them."""
