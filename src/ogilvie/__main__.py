"""`python -m ogilvie` is the command `ogilvie`, for where no script is on the path."""

from ogilvie.app.cli import main

if __name__ == "__main__":
    main()
