"""How figures look, and how they become SVG: the same bytes for the same numbers, always."""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from harness.report.slim import slim

# The colour-blind-safe palette of Okabe and Ito (2008).
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILLION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
GREY = "#6b6b6b"
PALE = "#eef1f4"

SETTINGS: dict[Any, object] = {
    "svg.hashsalt": "angular-voronoi",  # ids in the SVG do not depend on chance …
    "svg.fonttype": "none",  # … text stays text: it can be searched, read aloud, and is small
    "font.family": ["DejaVu Sans"],  # comes with matplotlib: the same metrics everywhere
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.7,
    "axes.labelsize": 9.0,
    "axes.unicode_minus": True,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.5,
    "grid.color": "#d9d9d9",
    "grid.linewidth": 0.5,
}
FALLBACK = "'DejaVu Sans', Verdana, Helvetica, sans-serif"

FORMATS = ("svg", "png", "pdf")
RESOLUTION = 200  # dots per inch of a PNG

#: What would make two files of the same picture differ is left out.
_NO_DATES: dict[str, dict[str, Any]] = {
    "svg": dict.fromkeys(("Date", "Creator", "Format", "Type")),
    "png": {"Software": None},
    "pdf": dict.fromkeys(("CreationDate", "Creator", "Producer")),
}


def saved(figure: Figure, form: str) -> bytes:
    """The bytes of a figure in one of the ``FORMATS``, under the settings in force."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format=form, dpi=RESOLUTION, metadata=_NO_DATES[form])
    data = buffer.getvalue()
    return data.replace(b"'DejaVu Sans'", FALLBACK.encode()) if form == "svg" else data


@contextmanager
def in_style(more: Mapping[Any, object] | None = None) -> Iterator[None]:
    """The project's settings of matplotlib and ``more``; the user's are back afterwards."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(SETTINGS)
        mpl.rcParams.update(dict(more or {}))
        yield


def render(draw: Callable[[Figure], None], width: float, height: float) -> str:
    """The SVG document of a figure, ``width`` × ``height`` inches, filled by ``draw``.

    Independent of the user's matplotlib settings, of the date and of figures drawn before.
    """
    with in_style():
        figure = Figure(figsize=(width, height))
        draw(figure)
        return slim(saved(figure, "svg").decode())


def inline(svg: str, prefix: str, description: str) -> str:
    """The SVG as an element of an HTML page.

    Its ids get a prefix, made from ``prefix`` and short, since a page holds many figures;
    ``description`` is what a screen reader says.  The prologue goes, and so does the fixed size:
    the page decides it.
    """
    prefix = "f" + hashlib.sha256(prefix.encode()).hexdigest()[:6]
    element = svg[svg.index("<svg") :]
    element = re.sub(r"<style type=\"text/css\">.*?</style>", "", element, count=1, flags=re.S)
    element = re.sub(r"<!--.*?-->\s*", "", element, flags=re.S)
    element = re.sub(r'\bid="', f'id="{prefix}-', element)
    element = re.sub(r'(xlink:href|href)="#', rf'\1="#{prefix}-', element)
    element = element.replace("url(#", f"url(#{prefix}-")
    element = re.sub(r'(<svg[^>]*?) width="[^"]*" height="[^"]*"', r"\1", element, count=1)
    label = description.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    return element.replace("<svg", f'<svg role="img" aria-label="{label}"', 1)
