"""The program `brinell`: `python -m brinell run SCENE`."""

import signal
import sys

from ._brinell import main as _main


def main():
    # The program hears Ctrl-C itself; Python would raise once more.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_main([sys.executable, "-m", "brinell"], ["brinell", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
