"""A contact sheet: every mesh's first picture, with its curvature beside it."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from app.batch.ledger import DONE, Record, files_of, thumbnail
from app.batch.store import Store
from app.batch.task import THUMBNAIL
from app.quantities import QUANTITIES

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageFont import FreeTypeFont

_PNG = "contact.png"
_COLUMNS, _GAP = 3, 10
_CELL = (THUMBNAIL[0] + 310, THUMBNAIL[1] + 2 * _GAP)
_MOST_ROWS = 60  # of one picture: viewers give up at some 16,000 pixels
PAGE = _COLUMNS * _MOST_ROWS
"""Most meshes of one page."""
_GROUND, _INK, _SOFT, _BAD = "#20242a", "#dde1e6", "#98a2ad", "#ff8a75"
_LETTERS = 13
_LINE = 17
_SHOWN = ("curvedness", "k1", "k2", "scale")


@dataclass(frozen=True)
class Cell:
    """One mesh on the sheet.

    Parameters
    ----------
    name : str
        The mesh's file.
    lines : tuple of str
        What is said of it.
    bad : str
        Why it failed; empty if it did not.
    picture, small : str
        Its first picture's path in the output folder, and that of a small copy; empty if it has
        none.
    files : tuple of str
        All its results.
    """

    name: str
    lines: tuple[str, ...]
    bad: str
    picture: str
    small: str
    files: tuple[str, ...]


def cells(records: Sequence[Record]) -> list[Cell]:
    """Return what the sheet shows.

    Parameters
    ----------
    records : sequence of dict
        Of the meshes.

    Returns
    -------
    list of Cell
        In the job's order.
    """
    return [_cell(record) for record in sorted(records, key=lambda record: record["n"])]


def _cell(record: Record) -> Cell:
    files = tuple(one["file"] for one in files_of(record))
    picture = next((name for name in files if name.endswith(".png")), "")
    bad = "" if record["reason"] == DONE else f"{record['reason']}: {record['message']}"
    name = record["mesh"].rpartition("/")[2]
    small = thumbnail(record["key"]) if picture else ""
    return Cell(name, tuple(_lines(record)), bad, picture, small, files)


def _lines(record: Record) -> list[str]:
    lines = []
    if "vertices" in record:
        lines.append(f"{record['vertices']:,} vertices, {record['faces']:,} triangles")
    if record.get("outputs"):
        first, size = record["outputs"][0], record["mm_per_unit"]
        lines.append(f"{first['estimator']}; 5 %, median, 95 %")
        found = first["percentiles"]
        for name in _SHOWN:
            values = [_mm(name, found[name][share], size) for share in ("p5", "p50", "p95")]
            lines.append(f"{name}  {'  '.join(values)} {QUANTITIES[name].printed_unit}")
        error = _mm("error", found["error"]["p50"], size)
        lines.append(f"error bar  {error} {QUANTITIES['error'].printed_unit} (median)")
    count = len(record.get("warnings", []))
    if count:
        lines.append(f"{count} warning{'s' * (count > 1)}")
    return lines


def _mm(name: str, value: float | None, mm_per_unit: float) -> str:
    return "-" if value is None else f"{value / mm_per_unit ** QUANTITIES[name].power:.3g}"


def write_page(store: Store, number: int, records: Sequence[Record]) -> None:
    """Write a page of the sheet as PNG, whole or not at all.

    Parameters
    ----------
    store : Store
        Where to; holds the pictures.
    number : int
        Which page, from 1.
    records : sequence of dict
        Of its meshes, `PAGE` at most.
    """
    name = _PNG if number == 1 else _PNG.replace(".", f"-{number}.")
    store.write(name, _drawn(store, cells(records)))


def _drawn(store: Store, shown: Sequence[Cell]) -> bytes:
    from PIL import Image, ImageDraw

    across = min(_COLUMNS, len(shown))
    rows = -(-len(shown) // across)
    sheet = Image.new("RGB", (across * _CELL[0], rows * _CELL[1]), _GROUND)
    pen = ImageDraw.Draw(sheet)
    plain, bold = _font(False), _font(True)
    for index, cell in enumerate(shown):
        row, column = divmod(index, across)
        x, y = column * _CELL[0] + _GAP, row * _CELL[1] + _GAP
        small = _small(store, cell.small)
        if small is not None:
            # Through its alpha, if it has any: the sheet is then its ground.
            sheet.paste(small, (x, y), small)
        x += THUMBNAIL[0] + _GAP
        width = _CELL[0] - THUMBNAIL[0] - 3 * _GAP
        lines = [(line, _INK, bold) for line in _wrapped(cell.name, bold, width)[:2]]
        lines += [(line, _BAD, plain) for line in _wrapped(cell.bad, plain, width)]
        lines += [
            (line, _SOFT, plain) for one in cell.lines for line in _wrapped(one, plain, width)
        ]
        for n, (line, ink, font) in enumerate(lines[: THUMBNAIL[1] // _LINE]):
            pen.text((x, y + n * _LINE), line, ink, font)
    out = io.BytesIO()
    sheet.save(out, format="PNG")
    return out.getvalue()


def _small(store: Store, name: str) -> "Image | None":
    from PIL import Image

    content = store.read(name) if name else None
    if content is None:
        return None
    with Image.open(io.BytesIO(content)) as picture:
        return picture.convert("RGBA")


def _font(bold: bool) -> "FreeTypeFont":
    from PIL import ImageFont

    # Where matplotlib keeps it: importing matplotlib to be told takes a fifth of a second.
    found = find_spec("matplotlib")
    assert found is not None
    assert found.origin is not None
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    place = Path(found.origin).parent / "mpl-data" / "fonts" / "ttf" / name
    return ImageFont.truetype(place, _LETTERS)


def _wrapped(text: str, font: "FreeTypeFont", width: int) -> list[str]:
    """Break text into lines, inside words where one is too long."""
    whole = " ".join(text.split())
    if font.getlength(whole) <= width:
        return [whole] if whole else []
    lines: list[str] = []
    line = ""
    for word in text.split():
        longer = f"{line} {word}".strip()
        if line and font.getlength(longer) > width:
            lines.append(line)
            longer = word
        while font.getlength(longer) > width:
            fits = next(n for n in range(len(longer), 0, -1) if font.getlength(longer[:n]) <= width)
            lines.append(longer[:fits])
            longer = longer[fits:]
        line = longer
    return [*lines, *([line] if line else [])]
