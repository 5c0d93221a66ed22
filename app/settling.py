"""Which model a scene was shaded with, where it was left open, in words and as data."""

from dataclasses import dataclass, fields

from app.session import Method
from lutcore.blend import Blend
from lutcore.shading import ShadingModel, model_registry


@dataclass(frozen=True)
class Settled:
    """The model that a scene is shaded with.

    Parameters
    ----------
    method : Method
        Its name, with the parameters that are not at their default.
    cheaper : Method or None
        The model that takes its place where that suffices.
    """

    method: Method
    cheaper: Method | None = None

    @property
    def label(self) -> str:
        """The model in words."""
        if self.cheaper is None:
            return self.method.label
        return f"{self.method.label}, {self.cheaper.label} where it suffices"

    def as_json(self) -> dict[str, object]:
        """Return it as plain data.

        Returns
        -------
        dict
            model, parameters and blended_with: the name of the cheaper one or None.
        """
        return {
            "model": self.method.name,
            "parameters": self.method.parameters,
            "blended_with": self.cheaper.name if self.cheaper else None,
        }


def settled(model: ShadingModel) -> Settled:
    """Name a model that `lutcore.shading.ShadingModel.settled` returned.

    Parameters
    ----------
    model : ShadingModel
        A registered model, or a blend of two.

    Returns
    -------
    Settled
        Its name and parameters.
    """
    if isinstance(model, Blend):
        return Settled(_method(model.good), _method(model.cheap))
    return Settled(_method(model))


def _method(model: ShadingModel) -> Method:
    values = {field.name: (getattr(model, field.name), field.default) for field in fields(model)}
    changed = {name: value for name, (value, default) in values.items() if value != default}
    return Method(model_registry.name_of(type(model)), changed)
