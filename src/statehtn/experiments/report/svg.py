"""Figures of matplotlib as SVG inside a page: light, in the page's colours and fonts, with ids of their own."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from matplotlib.figure import Figure

COLOURS = (
    *("ink", "muted", "grid"),
    *(f"series-{index}" for index in range(1, 7)),
    *(f"averse-{index}" for index in range(1, 4)),
    "neutral",
    *(f"seeking-{index}" for index in range(1, 4)),
)
"""The page's colours: custom properties of its style sheet, one value for light and one for dark."""
PLACEHOLDERS: Mapping[str, str] = {name: f"#a5c{index:03x}" for index, name in enumerate(COLOURS)}
"""What matplotlib is told instead; nothing else is drawn in these colours."""
STYLE: Any = {
    "svg.fonttype": "none",  # text stays text: it is light, and can be searched and read aloud
    "svg.hashsalt": "statehtn",  # the same figure is the same file
    "text.parse_math": False,  # names may contain dollars
    "path.simplify": False,
    "font.size": 11,
    "axes.labelsize": 11,
    "xtick.labelsize": 10,
    "ytick.labelsize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.linewidth": 0.6,
    "grid.color": PLACEHOLDERS["grid"],
    "axes.edgecolor": PLACEHOLDERS["muted"],
    "xtick.color": PLACEHOLDERS["muted"],
    "ytick.color": PLACEHOLDERS["muted"],
    "axes.labelcolor": PLACEHOLDERS["ink"],
    "text.color": PLACEHOLDERS["ink"],
    "xtick.minor.visible": False,
    "ytick.minor.visible": False,
}
"""Settings of matplotlib for figures that become such SVG."""
_PLACEHOLDER = re.compile("|".join(PLACEHOLDERS.values()))
_PROPERTIES = {value: f"var(--{name})" for name, value in PLACEHOLDERS.items()}
_NUMBER = re.compile(r"-?\d+\.\d+")
_REFERENCE = re.compile(r"url\(#([^)]+)\)")
_FONT = re.compile(r"font-family:[^;]*;? ?|font: [^;]*;? ?")
_NO_ROTATION = re.compile(r"^rotate\(-?0 [^)]*\)$")
XLINK = "{http://www.w3.org/1999/xlink}href"


def inline_svg(figure: Figure, name: str, label: str, tips: Mapping[str, Sequence[str]] | None = None) -> str:
    """Return a figure as an SVG element for a page of HTML.

    Args:
        figure: drawn with the settings `STYLE` and the colours `PLACEHOLDERS`.
        name: unique on the page; the ids begin with it.
        label: what the picture shows, for those who do not see it.
        tips: by the gid of a set of points, a text for each of them, shown when the mouse rests on it.
    """
    buffer = io.StringIO()
    figure.patch.set_visible(False)
    for axes in figure.axes:
        axes.patch.set_visible(False)
    figure.savefig(buffer, format="svg")
    root = ElementTree.fromstring(buffer.getvalue())
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]  # inside HTML the namespace is known
        element.text = element.text if element.tag == "text" else None
        element.tail = None
    root.attrib = {"class": "plot", "viewBox": root.attrib["viewBox"], "role": "img", "aria-label": label}
    _drop(root, {"metadata", "style"})
    for gid, texts in (tips or {}).items():
        _add_tips(root, gid, texts)
    _rename_ids(root, name)
    for element in root.iter():
        _lighten(element)
    _drop_empty(root)
    return ElementTree.tostring(root, encoding="unicode", short_empty_elements=True)


def _drop(parent: Element, tags: set[str]) -> None:
    """Drop elements; a style in an SVG inside a page would be one for all of the page."""
    for child in list(parent):
        if child.tag in tags:
            parent.remove(child)
        else:
            _drop(child, tags)


def _drop_empty(parent: Element) -> None:
    """Drop groups and definitions with nothing in them, and groups that say nothing."""
    children: list[Element] = []
    for child in list(parent):
        _drop_empty(child)
        if child.tag not in ("g", "defs") or (len(child) and child.attrib):
            children.append(child)
        else:
            children.extend(child if child.tag == "g" else [child] if len(child) else [])
    parent[:] = children


def _add_tips(root: Element, gid: str, texts: Sequence[str]) -> None:
    """Give the points of a set their texts; they are drawn in its order."""
    group = next(element for element in root.iter("g") if element.get("id") == gid)
    for point, text in zip(group.iter("use"), texts, strict=True):
        ElementTree.SubElement(point, "title").text = text


def _rename_ids(root: Element, name: str) -> None:
    """Keep the ids that are referred to, and begin them with the name."""
    used: dict[str, str] = {}
    for element in root.iter():
        references = [match[1] for value in element.attrib.values() for match in _REFERENCE.finditer(value)]
        if target := element.attrib.pop(XLINK, None):
            references.append(target[1:])
            element.set("href", target)
        for reference in references:
            used.setdefault(reference, f"{name}-{len(used)}")
    for element in root.iter():
        if (old := element.attrib.pop("id", None)) in used:
            element.set("id", used[old])
        for key, value in element.attrib.items():
            if key == "href":
                element.set(key, f"#{used[value[1:]]}")
            elif "url(#" in value:
                element.set(key, _REFERENCE.sub(lambda match: f"url(#{used[match[1]]})", value))


def _lighten(element: Element) -> None:
    """Round coordinates to hundredths, and leave colours and fonts to the page."""
    for key, value in list(element.attrib.items()):
        if key in ("d", "x", "y", "width", "height", "transform"):
            value = " ".join(_NUMBER.sub(lambda match: f"{float(match[0]):.2f}".rstrip("0").rstrip("."), value).split())
        elif key == "style":
            value = _PLACEHOLDER.sub(lambda match: _PROPERTIES[match[0]], _FONT.sub("", value)).strip()
        if key == "transform" and _NO_ROTATION.match(value):
            del element.attrib[key]
        else:
            element.set(key, value)
