"""`python -m handeye`."""

from handeye.cli import main

if __name__ == "__main__":
    main()
