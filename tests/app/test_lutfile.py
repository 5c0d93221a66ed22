"""Tables as files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.lutfile import load_table, save_table
from app.writing import WriteError
from lutcore.baking import bake, bake_plane
from lutcore.errors import ParameterError
from lutcore.lut import PsiTable
from lutcore.plane import PlaneTable

# 32-bit floats round to 6e-8 of a value; 16-bit steps are 1/65535 of a range, half of it is 7.6e-6.
ENDINGS = [(".npz", 0.0), (".exr", 6e-8), (".png", 7.7e-6)]


@pytest.mark.parametrize(("ending", "loss"), ENDINGS)
@pytest.mark.parametrize("name", ["skin1", "spectralon"])
def test_a_psi_table_comes_back(tmp_path: Path, ending: str, loss: float, name: str) -> None:
    table = bake(name)
    save_table(tmp_path / f"table{ending}", table)
    again = load_table(tmp_path / f"table{ending}")
    assert isinstance(again, PsiTable)
    for key, array in table.arrays().items():
        atol = loss * np.ptp(array, axis=-1).max() if key in ("psi", "slope") else 0.0
        np.testing.assert_allclose(again.arrays()[key], array, rtol=0.0, atol=atol, err_msg=key)


@pytest.mark.parametrize(("ending", "loss"), ENDINGS)
def test_a_plane_table_comes_back(tmp_path: Path, ending: str, loss: float) -> None:
    table = bake_plane("marble", 32, 0.5)
    save_table(tmp_path / f"table{ending}", table)
    again = load_table(tmp_path / f"table{ending}")
    assert isinstance(again, PlaneTable)
    assert again.limit == table.limit
    np.testing.assert_array_equal(again.mean_free_path, table.mean_free_path)
    np.testing.assert_allclose(again.values, table.values, rtol=0.0, atol=loss * table.values.max())


def test_the_png_has_16_bits_and_three_channels(tmp_path: Path) -> None:
    save_table(tmp_path / "t.png", bake("skin1"))
    header = (tmp_path / "t.png").read_bytes()[:33]
    width, height = (int.from_bytes(header[i : i + 4], "big") for i in (16, 20))
    depth, color = header[24], header[25]
    assert (width, height, depth, color) == (64, 2, 16, 2)


def test_a_texture_s_first_row_and_left_pixel_are_psi_of_zero(tmp_path: Path) -> None:
    from OpenImageIO import ImageInput

    save_table(tmp_path / "t.exr", bake("skin1"))
    source = ImageInput.open(str(tmp_path / "t.exr"))
    assert source is not None
    pixels = np.asarray(source.read_image(), dtype=np.float64)
    np.testing.assert_allclose(pixels[0, 0], bake("skin1").psi[:, 0], rtol=6e-8)


def test_an_unknown_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"\.npz"):
        save_table(tmp_path / "t.tiff", bake("skin1"))
    with pytest.raises(ParameterError, match=r"\.npz"):
        load_table(tmp_path / "t.tiff")


@pytest.mark.parametrize("ending", [".npz", ".exr", ".png"])
@pytest.mark.parametrize("content", [b"", b"no table", b"\x89PNG\r\n\x1a\n", b"PK\x03\x04"])
def test_what_is_no_table_is_refused(tmp_path: Path, ending: str, content: bytes) -> None:
    path = tmp_path / f"t{ending}"
    path.write_bytes(content)
    with pytest.raises(ParameterError, match="holds no table"):
        load_table(path)


@pytest.mark.parametrize("ending", [".npz", ".exr", ".png"])
def test_a_cut_off_table_is_refused(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"t{ending}"
    save_table(path, bake("skin1"))
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(ParameterError):
        load_table(path)


@pytest.mark.parametrize("ending", [".npz", ".exr", ".png"])
def test_a_missing_folder_and_a_missing_file_are_named(tmp_path: Path, ending: str) -> None:
    with pytest.raises(WriteError, match="nowhere"):
        save_table(tmp_path / "nowhere" / f"t{ending}", bake("skin1"))
    with pytest.raises(OSError, match="nothing"):
        load_table(tmp_path / f"nothing{ending}")


def test_an_old_file_survives_a_failed_write(tmp_path: Path) -> None:
    path = tmp_path / "t.npz"
    path.write_bytes(b"old")

    class Broken(PsiTable):
        def arrays(self) -> dict[str, np.ndarray]:
            raise KeyboardInterrupt

    fields: dict[str, Any] = bake("skin1").arrays()
    with pytest.raises(KeyboardInterrupt):
        save_table(path, Broken(**fields))
    assert path.read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["t.npz"]
