"""Draws one empty picture and prints what drew it; run as a child process by `doctor`."""

import json

from app import gl
from app.backend import backend_of


def main() -> None:
    """Print one line of JSON: what is missing, or renderer, vendor, version, window, software."""
    missing = gl.missing_packages()
    if missing:
        print(json.dumps({"missing": missing}))  # noqa: T201
        return
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  registers the OpenGL classes
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

    with gl.offscreen():
        window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(32, 32)
    window.AddRenderer(vtkRenderer())
    window.Render()
    backend = backend_of(window)
    found = {name: getattr(backend, name) for name in backend.__struct_fields__}
    found["window"] = window.GetClassName()
    software = any(word in found["renderer"].lower() for word in ("llvmpipe", "softpipe", "swr"))
    found["software"] = "yes" if software else "no"
    window.Finalize()
    print(json.dumps(found))  # noqa: T201


if __name__ == "__main__":
    main()
