# SPDX-License-Identifier: LGPL-3.0-or-later
"""What all pictures share: look, colours, and how they reach the disk."""

import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy  # noqa: F401
except ImportError as error:
    sys.exit(f"no pictures: numpy and matplotlib are needed ({error})")

STYLE = {
    "font.size": 10,
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 11,
    "axes.titlelocation": "left",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "savefig.dpi": 200,
    "savefig.bbox": "tight",
    "savefig.pad_inches": 0.08,
}
# Okabe and Ito's colours, told apart by everyone; yellow is left out on white.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
DASHES = ["-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (6, 1.5, 1.5, 1.5))]
COLOUR_MAP = "viridis"
INK = "#222222"


class Trouble(Exception):
    """What keeps a picture from being drawn, in words for the user."""


def save(figure, file):
    """Whole or not at all: a picture of an older run must not mix with this."""
    part = file.with_name(file.name + ".part")
    try:
        figure.savefig(part, format="png")
        part.replace(file)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise Trouble(f"{file}: {error.strerror or error}")
    finally:
        plt.close(figure)
