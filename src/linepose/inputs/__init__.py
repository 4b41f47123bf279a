"""What devices and other programs write, read into what the rest of the library works with."""
