"""The spacing of a TIFF stack: only ImageJ's and OME's files state that of the third axis."""

from typing import Any

_MILLIMETRES = {
    "nm": 1e-6,
    "um": 1e-3,
    "\u00b5m": 1e-3,
    "\u03bcm": 1e-3,
    "\\u00b5m": 1e-3,
    "micron": 1e-3,
    "microns": 1e-3,
    "micrometer": 1e-3,
    "mm": 1.0,
    "millimeter": 1.0,
    "cm": 10.0,
    "m": 1000.0,
    "inch": 25.4,
}
Spacing = tuple[float, float, float]


def spacing_of(file: Any) -> tuple[Spacing | None, bool]:
    """Return the distance of neighbouring voxels.

    Parameters
    ----------
    file : tifffile.TiffFile
        An open file.

    Returns
    -------
    tuple of 3 floats, or None
        Along x, y and z; None if the file does not say.
    bool
        Whether that is in millimetres; else in a unit that is not known.
    """
    if file.ome_metadata:
        return _ome(file.ome_metadata)
    if file.imagej_metadata and "spacing" in file.imagej_metadata:
        return _imagej(file)
    return None, False


def _imagej(file: Any) -> tuple[Spacing | None, bool]:
    across, down = file.pages[0].get_resolution()
    deep = float(file.imagej_metadata["spacing"])
    if not (across > 0.0 and down > 0.0 and deep > 0.0):
        return None, False
    unit = _MILLIMETRES.get(str(file.imagej_metadata.get("unit", "")).lower())
    size = unit or 1.0
    return (size / across, size / down, size * deep), unit is not None


def _ome(text: str) -> tuple[Spacing | None, bool]:
    from tifffile import xml2dict

    image = xml2dict(text)["OME"]["Image"]
    pixels = (image[0] if isinstance(image, list) else image)["Pixels"]
    found = []
    for axis in "XYZ":
        # OME states lengths in micrometres unless it says otherwise.
        unit = _MILLIMETRES.get(str(pixels.get(f"PhysicalSize{axis}Unit", "um")).lower())
        size = pixels.get(f"PhysicalSize{axis}")
        if size is None or unit is None or not float(size) > 0.0:
            return None, False
        found.append(float(size) * unit)
    return (found[0], found[1], found[2]), True
