"""A table of all meshes: one row each, for a spreadsheet or a data frame."""

import csv
import io
from collections.abc import Sequence
from typing import Any

from app.batch.ledger import Record
from app.batch.store import Store
from lutcore.errors import ParameterError

CSV, PARQUET = "summary.csv", "summary.parquet"
_TEXTS = ("mesh", "reason", "message", "sha256")
_COUNTS = ("n", "vertices", "faces", "warnings", "files", "bytes")
_SHARES = ("p5", "p50", "p95")
_QUANTITIES = ("k1", "k2", "mean", "gauss", "curvedness", "shape_index", "error", "scale")
_NUMBERS = (
    "mm_per_unit",
    "seconds",
    "peak_mib",
    *(f"{name}_{share}" for name in _QUANTITIES for share in _SHARES),
)
COLUMNS = ("n", "mesh", "reason", "message", *_COUNTS[1:3], *_NUMBERS, *_COUNTS[3:], "sha256")
"""What a row holds; curvature in mesh units, of the mesh's first result."""


def rows(records: Sequence[Record]) -> list[dict[str, Any]]:
    """Return the table.

    Parameters
    ----------
    records : sequence of dict
        Of the meshes.

    Returns
    -------
    list of dict
        One for each mesh in the job's order, with all of `COLUMNS`; None where nothing is known.
    """
    return [_row(record) for record in sorted(records, key=lambda record: record["n"])]


def _row(record: Record) -> dict[str, Any]:
    outputs = record.get("outputs", [])
    found = outputs[0]["percentiles"] if outputs else {}
    files = [file for output in outputs for file in output["files"]]
    told = {name: record.get(name) for name in (*_TEXTS, "n", "vertices", "faces", "mm_per_unit")}
    return told | {
        "seconds": record.get("seconds"),
        "peak_mib": record.get("memory", {}).get("peak_mib"),
        "warnings": len(record.get("warnings", [])),
        "files": len(files),
        "bytes": sum(file["bytes"] for file in files),
        **{
            f"{name}_{share}": found.get(name, {}).get(share)
            for name in _QUANTITIES
            for share in _SHARES
        },
    }


def write_csv(store: Store, records: Sequence[Record]) -> None:
    """Write the table as CSV, whole or not at all.

    Parameters
    ----------
    store : Store
        Where to.
    records : sequence of dict
        Of the meshes.
    """
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows(records))
    # A name that is no proper text, as file systems allow, must not end the writing.
    store.write(CSV, text.getvalue().encode("utf-8", "replace"))


def require_parquet() -> None:
    """Make sure, before long work, that a Parquet file can be written at its end.

    Raises
    ------
    ParameterError
        If pyarrow is not installed.
    """
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError:
        raise ParameterError(
            "--parquet needs the package pyarrow; install it with pip install 'curvelight[parquet]'"
        ) from None


def write_parquet(store: Store, records: Sequence[Record]) -> None:
    """Write the table as Parquet, whole or not at all.

    Parameters
    ----------
    store : Store
        Where to.
    records : sequence of dict
        Of the meshes.
    """
    import pyarrow
    import pyarrow.parquet

    kinds = (
        dict.fromkeys(_TEXTS, pyarrow.string())
        | dict.fromkeys(_COUNTS, pyarrow.int64())
        | dict.fromkeys(_NUMBERS, pyarrow.float64())
    )
    schema = pyarrow.schema([(name, kinds[name]) for name in COLUMNS])
    out = pyarrow.BufferOutputStream()
    pyarrow.parquet.write_table(pyarrow.Table.from_pylist(rows(records), schema), out)
    store.write(PARQUET, out.getvalue().to_pybytes())
