"""What drew a picture: the OpenGL behind a VTK window, in the driver's own words, and where."""

import platform
from typing import TYPE_CHECKING

import msgspec

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swiftshader", "software", "gdi generic")


class Backend(msgspec.Struct, frozen=True):
    """An OpenGL driver.

    Parameters
    ----------
    vendor, renderer, version : str
        As the driver calls them.
    """

    vendor: str
    renderer: str
    version: str

    @property
    def label(self) -> str:
        """All of it in one line."""
        return f"{self.renderer}, OpenGL {self.version}"

    @property
    def software(self) -> bool:
        """Whether the processor draws, as it does where there is no graphics card."""
        return any(name in self.renderer.lower() for name in _SOFTWARE)


def backend_of(window: "vtkRenderWindow") -> Backend:
    """Return what draws a window.

    Parameters
    ----------
    window : vtkRenderWindow
        One that has drawn. Asking takes a tenth of a millisecond.

    Returns
    -------
    Backend
        Its driver; what the driver does not say is empty.
    """
    found = dict.fromkeys(Backend.__struct_fields__, "")
    for line in window.ReportCapabilities().splitlines():
        key, _, value = line.partition(":")
        for name in found:
            if key.strip() == f"OpenGL {name} string":
                found[name] = value.strip()
    return Backend(**found)


def machine() -> str:
    """Return the system and the kind of processor, nothing that tells one of a kind from another.

    Returns
    -------
    str
        Such as ``Linux x86_64 znver4``.
    """
    from llvmlite import binding

    return f"{platform.system()} {platform.machine()} {binding.get_host_cpu_name()}"
