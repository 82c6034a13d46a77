"""Reading and writing instances: JSON, WKT, GeoJSON and anything with ``__geo_interface__``.

The instance file is JSON: ``{"kind": "polygon", "vertices": [[x, y], …]}`` or ``{"kind":
"segments", "segments": [[[x, y], [x, y]], …]}``, with optional ``name``, ``family``, ``params``
and ``seed``; other keys are ignored.  A coordinate is a JSON number, taken as its nearest double
exactly (integers too: exact up to 2⁵³), or a string holding an exact rational (``"1/3"``).  A
number that no finite double comes near (``1e400``) or that would vanish (``1e-400``) is refused.
The numbers of WKT and GeoJSON are read in the same way.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from harness.errors import UserError
from harness.files import replace
from harness.geometry.coordinates import Kind, Vanished
from harness.geometry.instance import Instance

_KEYS: dict[Kind, str] = {"polygon": "vertices", "segments": "segments"}
_WKT_TYPE = re.compile(r"\s*(?:SRID=\d+;)?\s*([A-Za-z]+)", re.ASCII)
_WKT_TOKEN = re.compile(r"\s*([(),]|[^\s(),]+)")


# ---------------------------------------------------------------- files


def read_instance(path: str | os.PathLike[str]) -> Instance:
    """The instance in a file, in whichever of the formats it is written.

    Raises :class:`UserError` naming the file, the index and the reason.  Only the form is
    checked here; see :func:`harness.geometry.validation.validate`.  Linear time.
    """
    source = os.fspath(path)
    try:
        text = Path(path).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise UserError(f"{source}: not a text file (UTF-8)") from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        raise UserError(f"{source}: {getattr(error, 'strerror', None) or error}") from None
    try:
        return parse_instance(text, source)
    except UserError as error:
        raise UserError(f"{source}: {error}") from None


def parse_instance(text: str, source: str | None = None) -> Instance:
    """The instance that ``text`` describes; ``source`` is only remembered.

    A byte order mark is no part of it.
    """
    text = text.removeprefix("\ufeff")
    word = _WKT_TYPE.match(text)
    if word and word[1].upper() in _WKT_READERS:
        kind, rows = _from_wkt(text[word.end() :], word[1].upper())
        return Instance.from_arrays(kind, rows, source=source)
    data = _load_json(text)
    if not isinstance(data, dict):
        raise UserError(f"not an instance: a JSON object is expected, not {_type_name(data)}")
    if "type" in data and "kind" not in data:
        kind, rows = geo_rows(data)
        return Instance.from_arrays(kind, rows, source=source)
    return _from_object(data, source)


def write_instance(instance: Instance, path: str | os.PathLike[str]) -> None:
    """Write an instance file; ``.wkt`` and ``.geojson`` choose those formats, all else is JSON.

    The file appears whole or not at all.  WKT and GeoJSON hold doubles only: an instance with
    other rationals raises :class:`UserError`, and so does a path that cannot be written.
    """
    target = Path(path)
    writer = {".wkt": to_wkt, ".geojson": to_geojson}.get(target.suffix.lower(), Instance.to_json)
    text = writer(instance)
    try:
        replace(target, text.encode())
    except OSError as error:
        raise UserError(f"{target}: {error.strerror or error}") from None


# ---------------------------------------------------------------- JSON


def _load_json(text: str) -> Any:
    """Parsed JSON in which numbers outside the doubles stay recognisable."""
    try:
        return json.loads(
            text,
            parse_float=_real_literal,
            parse_int=_integer_literal,
            object_pairs_hook=_unique_keys,
        )
    except json.JSONDecodeError as error:
        where = f"line {error.lineno}, column {error.colno}"
        raise UserError(f"not JSON: {error.msg} at {where}") from None
    except RecursionError:
        raise UserError("not an instance: lists are nested too deeply") from None


def _real_literal(literal: str) -> float:
    value = float(literal)
    if value == 0 and re.search("[1-9]", re.split("[eE]", literal)[0]):
        return Vanished(value)
    return value


def _integer_literal(literal: str) -> int | float:
    return int(literal) if len(literal) < 400 else float(literal)  # infinite: refused later


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        keys = [key for key, _ in pairs]
        repeated = next(key for key in keys if keys.count(key) > 1)
        raise UserError(f"not an instance: the key {repeated!r} appears twice")
    return table


def _from_object(data: dict[str, Any], source: str | None) -> Instance:
    """The instance of a JSON object, its descriptive fields checked."""
    kind = data.get("kind")
    if kind not in ("polygon", "segments"):
        found = "it is missing" if kind is None else f"not {json.dumps(kind)[:40]}"
        raise UserError(f'wrong kind: "kind" must be "polygon" or "segments", {found}')
    key = _KEYS[kind]
    if key not in data:
        raise UserError(f'a {kind} instance needs the key "{key}"')
    for other in _KEYS.values():
        if other != key and other in data:
            raise UserError(f'wrong kind: a {kind} instance has no key "{other}"')
    for name, wanted in (("name", str), ("family", str), ("params", dict), ("seed", int)):
        value = data.get(name)
        if value is not None and (not isinstance(value, wanted) or value is True or value is False):
            raise UserError(f'"{name}" must be {_TYPE_NAMES[wanted]}, not {_type_name(value)}')
    return Instance.from_arrays(
        kind,
        data[key],
        name=data.get("name"),
        family=data.get("family"),
        params=data.get("params") or {},
        seed=data.get("seed"),
        source=source,
    )


_TYPE_NAMES = {str: "a string", dict: "an object", int: "an integer", list: "a list"}


def _type_name(value: Any) -> str:
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    return _TYPE_NAMES.get(type(value), "a number")


# ---------------------------------------------------------------- GeoJSON


def geo_rows(data: Any) -> tuple[Kind, list[Any]]:
    """Kind and nested coordinates of a GeoJSON-like mapping (RFC 7946).

    One polygon without holes gives a polygon (a closing repeat of its first vertex is dropped);
    line strings give the segments between their successive points.
    """
    shapes = list(_geometries(data))
    types = {kind for kind, _ in shapes}
    if types == {"Polygon"} and len(shapes) == 1:
        return "polygon", _ring(shapes[0][1])
    if types == {"LineString"}:
        return "segments", [segment for _, line in shapes for segment in _steps(line)]
    raise UserError(
        "not an instance: one polygon or some line strings are expected, found "
        + (", ".join(sorted(types)) + f" ({len(shapes)} in all)" if shapes else "nothing")
    )


def _geometries(data: Any) -> Any:
    """The single polygons and line strings of a GeoJSON object, one by one."""
    if not isinstance(data, Mapping) or not isinstance(data.get("type"), str):
        raise UserError('not GeoJSON: an object with a "type" is expected')
    kind = data["type"]
    if kind == "FeatureCollection":
        for feature in _listed(data, "features"):
            yield from _geometries(feature)
    elif kind == "GeometryCollection":
        for geometry in _listed(data, "geometries"):
            yield from _geometries(geometry)
    elif kind == "Feature":
        yield from _geometries(data.get("geometry"))
    elif kind in ("Polygon", "LineString"):
        yield kind, _listed(data, "coordinates")
    elif kind in ("MultiPolygon", "MultiLineString"):
        for part in _listed(data, "coordinates"):
            yield kind.removeprefix("Multi"), part
    elif kind == "LinearRing":
        yield "Polygon", [_listed(data, "coordinates")]
    else:
        raise UserError(f"not an instance: {kind} is neither a polygon nor a line string")


def _listed(data: Mapping[str, Any], key: str) -> Any:
    value = data.get(key)
    if not isinstance(value, list | tuple):
        raise UserError(f'{data["type"]} without a list of "{key}"')
    return value


def _ring(rings: Any) -> list[Any]:
    """The vertices of a polygon given by its rings, which must be just the outer one."""
    if not isinstance(rings, list | tuple) or not all(isinstance(r, list | tuple) for r in rings):
        raise UserError("a polygon is a list of rings, each a list of points")
    if len(rings) > 1:
        raise UserError(f"the polygon has {len(rings) - 1} hole(s): only simple polygons are taken")
    ring = list(rings[0]) if rings else []
    return ring[:-1] if len(ring) > 1 and ring[0] == ring[-1] else ring


def _steps(line: Any) -> list[Any]:
    """The segments between successive points of a line string."""
    if not isinstance(line, list | tuple) or len(line) < 2:
        raise UserError("a line string needs at least two points")
    return [list(pair) for pair in pairwise(line)]


def to_geojson(instance: Instance) -> str:
    """The instance as a GeoJSON geometry; raises :class:`UserError` if it is not all doubles."""
    _require_doubles(instance, "GeoJSON")
    rows: list[Any] = instance.floats.tolist()
    shape: dict[str, Any] = {"type": "MultiLineString", "coordinates": rows}
    if instance.kind == "polygon":
        shape = {"type": "Polygon", "coordinates": [rows + rows[:1]]}
    return json.dumps(shape, allow_nan=False) + "\n"


# ---------------------------------------------------------------- WKT


def _from_wkt(body: str, word: str) -> tuple[Kind, list[Any]]:
    """Kind and nested coordinates of well-known text, whose first word has been read."""
    tokens = [match[1] for match in _WKT_TOKEN.finditer(body)]
    dimension = tokens.pop(0).upper() if tokens and tokens[0].upper() in ("Z", "M", "ZM") else ""
    if dimension:
        raise UserError(f"{word} {dimension}: only plane coordinates (x y) are taken")
    if [token.upper() for token in tokens] == ["EMPTY"]:
        raise UserError(f"{word} EMPTY: there is nothing in it")
    return geo_rows({"type": _WKT_READERS[word], "coordinates": _wkt_lists(tokens, word)})


_WKT_READERS = {
    "POLYGON": "Polygon",
    "LINESTRING": "LineString",
    "MULTILINESTRING": "MultiLineString",
    "MULTIPOLYGON": "MultiPolygon",
    # known by name, so that the message is about the geometry and not about JSON:
    "POINT": "Point",
    "MULTIPOINT": "MultiPoint",
    "GEOMETRYCOLLECTION": "Geometry collection (WKT)",
}


def _wkt_lists(tokens: list[str], word: str) -> list[Any]:
    """The nested lists that parentheses and commas describe; ``x y`` is a point."""
    if word not in ("POLYGON", "LINESTRING", "MULTILINESTRING", "MULTIPOLYGON"):
        return []  # refused by its type
    stack: list[list[Any]] = [[]]
    point: list[float] = []
    for token in [*tokens, ","]:
        if token in "(),":
            if point:
                stack[-1].append(point)
                point = []
            if token == "(":
                stack.append([])
            elif token == ")" and len(stack) > 1:
                closed = stack.pop()
                stack[-1].append(closed)
            elif token == ")":
                raise UserError(f"{word}: unbalanced parentheses")
        else:
            point.append(_wkt_number(token, word))
    if len(stack) != 1 or len(stack[0]) != 1 or not isinstance(stack[0][0], list):
        raise UserError(f"{word}: unbalanced parentheses, or text after the geometry")
    found: list[Any] = stack[0][0]
    return found


def _wkt_number(token: str, word: str) -> float:
    if re.fullmatch(r"[+-]?(nan|inf(inity)?)", token, re.IGNORECASE):
        return float(token)  # refused later, with its index
    if not re.fullmatch(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", token, re.ASCII):
        raise UserError(f"{word}: {token[:40]!r} is not a number")
    return _real_literal(token)


def to_wkt(instance: Instance) -> str:
    """The instance as well-known text; raises :class:`UserError` if it is not all doubles."""
    _require_doubles(instance, "WKT")
    points = [f"{x!r} {y!r}" for x, y in instance.floats.reshape(-1, 2).tolist()]
    if instance.kind == "polygon":
        return f"POLYGON (({', '.join(points + points[:1])}))\n"
    pairs = zip(points[::2], points[1::2], strict=True)
    return "MULTILINESTRING (" + ", ".join(f"({a}, {b})" for a, b in pairs) + ")\n"


def _require_doubles(instance: Instance, what: str) -> None:
    if instance.exact is not None:
        raise UserError(f"{what} cannot hold rational coordinates exactly; write JSON instead")
