"""The shading models in GLSL 1.50, for the shaders that VTK puts together.

The same formulas as `plugins.shading`, `lutcore.lights` and `lutcore.color`; tests hold them
together. What changes little within a triangle is computed at its corners: the bend of the surface
towards each light, the area's correction, the cosine towards the camera. Normals, response,
Fresnel factors and encoding are those of the pixel. Positions are relative to the origin of the
view, light is linear until the last line.
"""

from collections.abc import Sequence

from app.shader.look import PixelLook
from app.shader.packing import Packing
from lutcore.lights import LIGHT_FIELDS
from lutcore.response_table import BEND, COLUMNS, MOST, ROWS

EYE, EXPOSURE, LIGHTS = "glowEye", "glowExposure", "glowLights"
"""Uniforms that follow what moves; those of a look are in `PixelLook.numbers`."""
TABLE = "glowTable"
"""The texture."""

# A vertex without a normal has none between, and stays dark.
_UNIT = """
vec3 glowUnit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-30)); }
"""
_BENDING = """
float glowBend(vec3 n, vec3 form, vec3 w) {
  // The frame of app.shader.vertices.forms.
  float side = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (side + n.z), b = n.x * n.y * a;
  float p = dot(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x), w);
  float q = dot(vec3(b, side + n.y * n.y * a, -n.y), w);
  return length(vec2(form.x * p + form.z * q, form.z * p + form.y * q));
}
"""
_TRANSMITTANCE = """
float glowEntering(float c, float n) {
  float inside = sqrt(max(1.0 - (1.0 - c * c) / (n * n), 0.0));
  float crossing = (c - n * inside) / (c + n * inside + 1e-20);
  float parallel = (n * c - inside) / (n * c + inside + 1e-20);
  return 1.0 - 0.5 * (crossing * crossing + parallel * parallel);
}
"""
# Between samples of a pixel a bend may come out below 0. The texture is not filtered: a place in
# the middle of a texel names it, and costs less than its indices.
_RESPONSE = f"""
float glowOf(float a, float bend, int c) {{
  float kappa = max(bend, 0.0), root = sqrt(kappa);
  vec2 at = vec2({COLUMNS / 2:.1f} + {COLUMNS / 2 * (BEND + MOST) / MOST} * a / ({BEND} + abs(a)),
                 min({ROWS:.1f} * root / (glowHalfway[c] + root), {ROWS - 0.001}));
  vec2 cell = floor(at), f = at - cell;
  vec2 middle = cell + vec2(0.5, 0.5 + {ROWS:.1f} * float(c));
  vec4 k = texture(glowTable, middle * vec2({1.0 / COLUMNS}, {1.0 / (3 * ROWS)}));
  return (1.0 + glowLength[c] * kappa) * (k.x + f.x * k.y + f.y * (k.z + f.x * k.w));
}}
"""
# IEC 61966-2-1, as in lutcore.color, its power as a polynomial in the fourth root: within .01/255.
_SEEN = """
glowShone = clamp(glowExposure * vec3({entering}) * {kept} * glowShone, 0.0, 1.0);
vec3 glowRoot = sqrt(glowShone), glowFourth = sqrt(glowRoot);
vec3 glowPower = -0.06461153 + 0.19613584 * glowFourth
  + glowRoot * (1.12268167 - 0.3355016 * glowFourth + 0.08132999 * glowRoot);
gl_FragData[0] = vec4(mix(12.92 * glowShone, glowPower, step(0.0031308, glowShone)), 1.0);
"""


class Glow:
    """The code for a look under lights of given kinds.

    Parameters
    ----------
    look : PixelLook
        The model, and what each vertex has.
    beamed : sequence of bool
        For each light whether it has a position.
    """

    def __init__(self, look: PixelLook, beamed: Sequence[bool]) -> None:
        self._look, self._beamed = look, tuple(beamed)
        self._channels = range(3 if look.by_channel else 1)
        self._bent = look.table is not None
        parts = {f"facing{c}": 3 for c in self._channels} | {"seen": 1}
        if self._bent:
            parts |= {f"bend{light}": len(self._channels) for light in range(len(self._beamed))}
        if "kept" in look.parts:
            parts["kept"] = 3
        if any(self._beamed):
            parts["place"] = 3
        self._passed = Packing("glowPassed", parts)

    @property
    def vertex_functions(self) -> str:
        """What the vertex shader needs before its main function."""
        given, passed = self._look.parts.declared("in"), self._passed.declared("out")
        return given + passed + _UNIT + (_BENDING if self._bent else "")

    @property
    def vertex_code(self) -> str:
        """What the vertex shader does."""
        given = self._look.parts
        leaving = given.taken("leaving" if "leaving" in given else "facing0")
        values = {"seen": f"dot({leaving}, glowView)", "place": "vertexMC.xyz"}
        same = [f"facing{c}" for c in self._channels] + ["kept"]
        values |= {part: given.taken(part) for part in same if part in given}
        towards = ""
        if self._bent:
            for light, beamed in enumerate(self._beamed):
                w = self._vector(light, 1)
                towards += f"vec3 w{light} = "
                towards += f"glowUnit({w} - vertexMC.xyz);\n" if beamed else f"{w};\n"
                values[f"bend{light}"] = _joined([self._bend(c, light) for c in self._channels])
        view = """vec3 glowView = vec3(glowEye[0], glowEye[1], glowEye[2]);
if (glowEye[3] > 0.0) glowView = normalize(glowView - vertexMC.xyz);
"""
        return view + towards + self._passed.given(values)

    @property
    def pixel_inputs(self) -> str:
        """What the fragment shader gets."""
        return self._passed.declared("in")

    @property
    def pixel_functions(self) -> str:
        """What the fragment shader needs before its main function, behind its textures."""
        return _UNIT + _TRANSMITTANCE + (_RESPONSE if self._bent else "")

    @property
    def pixel_code(self) -> str:
        """What gives a pixel its colour."""
        code = "vec3 glowShone = vec3(0.0);\n"
        for c in self._channels:
            code += f"vec3 n{c} = glowUnit({self._passed.taken(f'facing{c}')});\n"
        code += "".join(map(self._lit, range(len(self._beamed))))
        kept = "vec3(glowTotal[0], glowTotal[1], glowTotal[2])"
        if "kept" in self._passed:
            kept = self._passed.taken("kept")
        # The constructor of a vector takes one number for all three.
        indices = range(3 if len(set(self._look.numbers["glowEta"])) > 1 else 1)
        seen = self._passed.taken("seen")
        entering = ", ".join(f"glowEntering(abs({seen}), glowEta[{c}])" for c in indices)
        return code + _SEEN.format(entering=entering, kept=kept)

    def _bend(self, channel: int, light: int) -> str:
        given = self._look.parts
        vectors = given.taken(f"facing{channel}"), given.taken(f"form{channel}")
        return f"glowBend({', '.join(vectors)}, w{light})"

    def _lit(self, light: int) -> str:
        color = self._vector(light, 8)
        code = f"vec3 w{light} = {self._vector(light, 1)};\n"
        if self._beamed[light]:
            away, square = f"dot(w{light}, {self._vector(light, 4)})", f"square{light}"
            edge = f"glowLights[{LIGHT_FIELDS * light + 7}]"
            code += f"w{light} -= {self._passed.taken('place')};\n"
            code += f"float {square} = dot(w{light}, w{light});\n"
            code += f"w{light} = glowUnit(w{light});\n"
            color += f" * ({square} > 0.0 && -{away} >= {edge} ? 1.0 / {square} : 0.0)"
        cosines = [f"dot(n{c}, w{light})" for c in self._channels]
        if not self._bent:
            cosine = f"max({_joined(cosines)}, 0.0)"
            return code + f"glowShone += {color} * {cosine}{self._entering(cosines)};\n"
        bend = self._passed.taken(f"bend{light}")
        code += f"{'vec3' if self._look.by_channel else 'float'} bend{light} = {bend};\n"
        own = [
            f"glowOf({cosines[c]}, bend{light}[{c}], {c})"
            if self._look.by_channel
            else f"glowOf({cosines[0]}, bend{light}, {c})"
            for c in range(3)
        ]
        return code + f"glowShone += {color} * {_joined(own)};\n"

    def _entering(self, cosines: list[str]) -> str:
        if not self._look.directional:
            return ""
        if len(set(self._look.numbers["glowEta"])) > 1:
            cosines = [cosines[min(c, len(cosines) - 1)] for c in range(3)]
        entered = [f"glowEntering(max({a}, 0.0), glowEta[{c}])" for c, a in enumerate(cosines)]
        return f" * {_joined(entered)}"

    @staticmethod
    def _vector(light: int, field: int) -> str:
        at = LIGHT_FIELDS * light + field
        return f"vec3(glowLights[{at}], glowLights[{at + 1}], glowLights[{at + 2}])"


def _joined(values: list[str]) -> str:
    return values[0] if len(values) == 1 else f"vec3({', '.join(values)})"
