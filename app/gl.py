"""Whether this machine can draw, asked before VTK is: without OpenGL VTK ends the process."""

import ctypes
import ctypes.util
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from lutcore.errors import CurvelightError

# Library that is loaded: Debian package that holds it.
_NEEDED = {"libEGL.so.1": "libegl1", "libGL.so.1": "libgl1"}
_DRIVERS = "libgl1-mesa-dri"
_PLATFORM_DEVICE = 0x313F  # EGL_PLATFORM_DEVICE_EXT
_MOST_DEVICES = 16


class DrawingError(CurvelightError):
    """The machine has no working OpenGL."""


def missing_packages() -> list[str]:
    """Return the Debian packages that drawing without a screen needs and that are not here.

    Returns
    -------
    list of str
        Empty where all is there, and on systems other than Linux.
    """
    missing = missing_libraries()
    if missing or not sys.platform.startswith("linux"):
        return missing
    return [] if _egl_starts() else [_DRIVERS]


def missing_libraries() -> list[str]:
    """Return the Debian packages whose libraries are not here, asking no driver.

    Returns
    -------
    list of str
        Empty where all is there, and on systems other than Linux.
    """
    if not sys.platform.startswith("linux"):
        return []
    return [package for library, package in _NEEDED.items() if not _loads(library)]


def require() -> None:
    """Make sure that drawing can be tried.

    Raises
    ------
    DrawingError
        If a library is missing; names what to install.
    """
    missing = missing_packages()
    if missing:
        raise DrawingError(
            f"pictures need OpenGL, which is not here; install {' '.join(missing)} "
            "(as root: apt-get install "
            f"{' '.join(missing)}), or write data instead: -o NAME.vtp, .ply or .npz"
        )


@contextmanager
def offscreen() -> Iterator[None]:
    """Make VTK choose a window that needs no screen while the block runs.

    Yields
    ------
    None
        Nothing.
    """
    name = "VTK_DEFAULT_OPENGL_WINDOW"
    if not sys.platform.startswith("linux") or name in os.environ:
        yield
        return
    # EGL draws the same picture as X11, bit for bit, and asks no X server.
    os.environ[name] = "vtkEGLRenderWindow"
    try:
        yield
    finally:
        del os.environ[name]


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _egl_starts() -> bool:
    # EGL loads without any driver behind it; only initialising a device shows that one is there.
    egl = ctypes.CDLL("libEGL.so.1")
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    pointer, integer = ctypes.c_void_p, ctypes.c_int
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    display_of = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not query or not display_of:
        return False
    query_devices = ctypes.CFUNCTYPE(integer, integer, pointer, pointer)(query)
    platform_display = ctypes.CFUNCTYPE(pointer, integer, pointer, pointer)(display_of)
    egl.eglInitialize.argtypes = [pointer, pointer, pointer]
    devices, count = (pointer * _MOST_DEVICES)(), integer(0)
    query_devices(_MOST_DEVICES, devices, ctypes.byref(count))
    displays = [platform_display(_PLATFORM_DEVICE, devices[i], None) for i in range(count.value)]
    return any(display and egl.eglInitialize(display, None, None) for display in displays)
