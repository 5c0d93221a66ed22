from dataclasses import dataclass

import pytest

from lutcore.errors import ParameterError
from lutcore.parameters import Parameters, choice, create, declared, param


@dataclass(frozen=True)
class Example(Parameters):
    width: float = param(0.5, 0.0, 1.0, "mm", "How wide.")
    count: int = param(4, 1, 16, "", "How many.")
    way: str = choice("near", ("near", "far"), "Which way.")


def test_defaults_are_checked_values():
    assert (Example().width, Example().count, Example().way) == (0.5, 4, "near")


def test_text_becomes_the_number_it_says():
    made = create(Example, "example", {"width": "0.25", "count": "8"})
    assert (made.width, made.count) == (0.25, 8)
    assert isinstance(made.count, int)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"width": 2.0}, "width = 2.0 is outside its range 0 to 1 mm"),
        ({"width": float("nan")}, "outside its range"),
        ({"width": "wide"}, "'wide' is not a number"),
        ({"count": 2.5}, "not a whole number"),
        ({"way": "nea"}, "did you mean 'near'"),
        ({"way": 3}, "unknown way 3"),
        ({"widht": 0.1}, "unknown parameter of example 'widht'; did you mean 'width'"),
    ],
)
def test_values_that_cannot_be_are_refused_by_name(values, said):
    with pytest.raises(ParameterError, match=said):
        create(Example, "example", values)


def test_one_declaration_tells_all():
    specs = declared(Example)
    assert list(specs) == ["width", "count", "way"]
    assert specs["width"].unit == "mm"
    assert specs["way"].options == ("near", "far")
