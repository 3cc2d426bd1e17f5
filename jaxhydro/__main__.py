"""Entry point of `python -m jaxhydro`, the same as `jaxhydro`."""

from jaxhydro.cli.app import main

if __name__ == "__main__":  # workers that are spawned come by here too
    main()
