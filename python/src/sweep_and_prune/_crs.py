"""Which coordinate reference system the coordinates of a file have, and whether two files have the same."""

from __future__ import annotations

import json
from typing import Any

LONGITUDE_LATITUDE = "OGC:CRS84"
"""What GeoJSON always has, and GeoParquet where it does not say otherwise."""
_ALIKE = {"OGC:CRS84", "EPSG:4326"}
"""They differ in the order of their axes only, and in files longitude comes first in both."""


def of_geoparquet(metadata: dict[bytes, bytes] | None) -> tuple[str | None, Any]:
    """The column of geometries that the metadata of a schema name, and its system; None where they say nothing."""
    geo = (metadata or {}).get(b"geo")
    if geo is None:
        return None, None
    try:
        document = json.loads(geo)
        column: str = document["primary_column"]
        return column, document["columns"][column].get("crs", LONGITUDE_LATITUDE)
    except (AttributeError, KeyError, TypeError, ValueError):
        raise ValueError('the metadata "geo" are not those of GeoParquet: write the table again') from None


def of_geojson(document: dict[str, Any]) -> Any:
    """The system that a document names as GeoJSON once did, or the one of GeoJSON."""
    crs = document.get("crs", LONGITUDE_LATITUDE)
    try:
        return crs["properties"]["name"] if isinstance(crs, dict) else crs
    except (KeyError, TypeError):
        return None


def difference(first: Any, second: Any) -> tuple[str, str] | None:
    """The names of two systems if they are known and differ."""
    if first is None or second is None:
        return None
    names = _name(first), _name(second)
    if names[0] == names[1] or set(names) <= _ALIKE or first == second:
        return None
    try:
        from pyproj import CRS
        from pyproj.exceptions import CRSError
    except ImportError:
        return names
    try:
        one, other = CRS.from_user_input(first), CRS.from_user_input(second)
    except CRSError:
        return names
    return None if one.equals(other, ignore_axis_order=True) else names


def _name(crs: Any) -> str:
    """What people call a system, such as EPSG:25832."""
    if isinstance(crs, dict):
        identifier = crs.get("id")
        if isinstance(identifier, dict) and {"authority", "code"} <= set(identifier):
            return f"{identifier['authority']}:{identifier['code']}"
        return str(crs.get("name", "one without a name"))
    parts = str(crs if isinstance(crs, str) else crs.to_string()).split(":")
    return f"{parts[-3]}:{parts[-1]}" if parts[:3] == ["urn", "ogc", "def"] and len(parts) > 5 else ":".join(parts)
