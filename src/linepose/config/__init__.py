"""The study's and the platforms' configuration: closed schemas, each key with its unit and default."""
