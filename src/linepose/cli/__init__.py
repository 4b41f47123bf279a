"""The command line `linepose`: one command a file, each a thin shell around what the Python API does."""


def main() -> None:
    """Run the command that was asked for; a user's fault ends in one line and exit code 1 or 2."""
    from linepose.cli.app import app

    app(prog_name="linepose")
