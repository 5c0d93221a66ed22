"""One model part of a 3MF file: objects, what they are made of, and what is to be built."""

from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from xml.parsers import expat

import numpy as np

from app.loading.errors import BadContentError
from lutcore.arrays import AnyArray, FloatArray

# Depth of the elements that matter; no writer goes further than a few more.
_MOST_DEPTH = 64


@dataclass(frozen=True)
class Part:
    """An object placed in the build, or in another object.

    Parameters
    ----------
    target : (str, str)
        The part of the archive and the object's id in it.
    transform : ndarray, shape=(4, 4), or None
        For rows: ``[x y z 1] @ transform``. None leaves it where it was made.
    """

    target: tuple[str, str]
    transform: FloatArray | None


@dataclass
class ModelObject:
    """An object: triangles, or other objects.

    Parameters
    ----------
    kind : str
        ``"model"``, ``"support"`` and so on.
    colored : bool
        Whether it has colours or other properties by face.
    vertices : ndarray, shape=(n, 3)
        Positions.
    faces : ndarray of int64, shape=(m, 3)
        Vertex indices, all of vertices that exist.
    parts : list of Part
        Its components.
    """

    kind: str
    colored: bool
    vertices: FloatArray = field(default_factory=lambda: np.empty((0, 3)))
    faces: AnyArray = field(default_factory=lambda: np.empty((0, 3), np.int64))
    parts: list[Part] = field(default_factory=list)


@dataclass
class Model:
    """What one XML part holds.

    Parameters
    ----------
    unit : str
        The unit's name.
    objects : dict of str to ModelObject
        Objects by their ids.
    items : list of Part
        What is to be built.
    """

    unit: str = "millimeter"
    objects: dict[str, ModelObject] = field(default_factory=dict)
    items: list[Part] = field(default_factory=list)


def parse_model(content: bytes, path: str) -> Model:
    """Parse one model part.

    Parameters
    ----------
    content : bytes
        Its XML.
    path : str
        Its name in the archive.

    Returns
    -------
    Model
        What it holds.

    Raises
    ------
    BadContentError
        If it is no such XML, or declares entities, which the format forbids and which can unfold
        without end.
    """
    builder = _Builder(path)
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.buffer_text = True
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.StartDoctypeDeclHandler = builder.refuse_doctype
    try:
        parser.Parse(content, True)
        return builder.model
    except expat.ExpatError as error:
        said = expat.ErrorString(error.code)
        raise BadContentError(f"line {error.lineno} of {path}: {said}") from None
    except (LookupError, ValueError, OverflowError) as error:
        # A LookupError, too, for an encoding that nobody knows.
        raise BadContentError(
            f"line {parser.CurrentLineNumber} of {path}: {builder.element!r} has "
            + (f"no {error}" if isinstance(error, KeyError) else f"a wrong value ({error})")
        ) from None


class _Builder:
    def __init__(self, path: str) -> None:
        self.model = Model()
        self.element = ""
        self._path = path
        self._depth = 0
        self._object: ModelObject | None = None
        # Not lists, whose numbers take many times the memory.
        self._points = array("d")
        self._corners = array("q")
        self._actions: dict[str, Callable[[dict[str, str]], None]] = {
            "model": self._start_model,
            "object": self._start_object,
            "vertex": self._vertex,
            "triangle": self._triangle,
            "component": self._component,
            "item": self._item,
        }

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        if self._depth > _MOST_DEPTH:
            raise BadContentError(f"the XML of {self._path} is more than {_MOST_DEPTH} deep")
        self.element = name.rpartition(" ")[2]
        action = self._actions.get(self.element)
        if action is not None:
            action(attributes)

    def end(self, name: str) -> None:
        self._depth -= 1
        if name.rpartition(" ")[2] != "object" or self._object is None:
            return
        found = self._object
        found.vertices = np.array(self._points).reshape(-1, 3)
        found.faces = np.array(self._corners).reshape(-1, 3)
        wrong = ((found.faces < 0) | (found.faces >= len(found.vertices))).any(axis=1)
        if wrong.any():
            # Checked here, for an index beyond one object would be a vertex of the next.
            face = int(np.argmax(wrong))
            raise BadContentError(
                f"triangle {face} (from 0) of an object uses vertices that do not exist: "
                f"{found.faces[face].tolist()} of {len(found.vertices)} vertices"
            )
        self._object = None

    def refuse_doctype(self, *_: object) -> None:
        raise BadContentError(
            f"the XML of {self._path} declares a document type, which 3MF forbids",
            "export it again with another program",
        )

    def _start_model(self, attributes: dict[str, str]) -> None:
        self.model.unit = attributes.get("unit", "millimeter")

    def _start_object(self, attributes: dict[str, str]) -> None:
        self._object = ModelObject(attributes.get("type", "model"), "pid" in attributes)
        self._points, self._corners = array("d"), array("q")
        name = attributes["id"]
        if name in self.model.objects:
            raise ValueError(f"two objects have the id {name!r:.40}")
        self.model.objects[name] = self._object

    def _vertex(self, attributes: dict[str, str]) -> None:
        self._points.extend(float(attributes[axis]) for axis in "xyz")

    def _triangle(self, attributes: dict[str, str]) -> None:
        self._corners.extend(int(attributes[corner]) for corner in ("v1", "v2", "v3"))
        if "p1" in attributes and self._object is not None:
            self._object.colored = True

    def _component(self, attributes: dict[str, str]) -> None:
        if self._object is not None:
            self._object.parts.append(self._part(attributes))

    def _item(self, attributes: dict[str, str]) -> None:
        self.model.items.append(self._part(attributes))

    def _part(self, attributes: dict[str, str]) -> Part:
        # The production extension puts objects into other parts of the archive.
        path = next(
            (value for name, value in attributes.items() if name.endswith(" path")), self._path
        )
        transform = None
        if "transform" in attributes:
            rows = np.array([float(word) for word in attributes["transform"].split()])
            transform = np.eye(4)
            transform[:, :3] = rows.reshape(4, 3)
        return Part((path.lstrip("/"), attributes["objectid"]), transform)
