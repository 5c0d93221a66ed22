"""The shading models in GLSL 1.50, for the fragment shader that VTK puts together.

The same formulas as `plugins.shading`, `lutcore.lut`, `lutcore.lights` and `lutcore.color`; tests
hold them together. Positions are relative to the origin of the view, light is linear until the
last line.
"""

from app.shader.look import HALF, MOST_LIGHTS, PixelLook
from lutcore.lights import LIGHT_FIELDS

EYE, EXPOSURE, LIGHTS, COUNT = "glowEye", "glowExposure", "glowLights", "glowCount"
"""Uniforms that follow what moves; those of a look are in `PixelLook.numbers`."""
TABLE = "glowTable"
"""The texture."""
_PLACE = "glowPlace"

_TRANSMITTANCE = """
float glowEntering(float c, float n) {
  float inside = sqrt(max(1.0 - (1.0 - c * c) / (n * n), 0.0));
  float crossing = (c - n * inside) / (c + n * inside + 1e-20);
  float parallel = (n * c - inside) / (n * c + inside + 1e-20);
  return 1.0 - 0.5 * (crossing * crossing + parallel * parallel);
}
// A vertex without a normal has none between, and stays dark.
vec3 glowUnit(vec3 v) { return v / max(length(v), 1e-20); }
"""
# The tiny number only decides 0/0, where the glow is 0 times psi(0).
_CURVED = """
float glowOf(float cosine, vec3 bending, int c) {
  float b = glowLength[c] * length(bending);
  float even = 0.0, lit = 0.0;
  for (int j = 0; j < {hinges}; ++j) {
    float a = cosine - glowCorners[{hinges} * c + j];
    float at = {last}.0 * b / (b + {half} * abs(a) + 1e-20);
    int segment = int(at);
    float psi = texelFetch(glowTable, ivec2(segment, c), 0).r;
    float next = texelFetch(glowTable, ivec2(min(segment + 1, {last}), c), 0).r;
    lit += glowWeights[{hinges} * c + j] * max(a, 0.0);
    even += glowWeights[{hinges} * c + j] * (mix(psi, next, at - float(segment)));
  }
  return lit + b * even;
}
vec3 glowBending(vec3 spread, vec3 twist, vec3 w) {
  return vec3(dot(vec3(spread.x, twist.x, twist.z), w),
              dot(vec3(twist.x, spread.y, twist.y), w),
              dot(vec3(twist.z, twist.y, spread.z), w));
}
float glowArea2(vec3 spread, vec3 twist) {
  float trace = spread.x + spread.y + spread.z;
  return 2.0 * (dot(spread, spread) + 2.0 * dot(twist, twist)) + trace * trace;
}
"""
_LIGHT = """
vec3 glowShone = vec3(0.0);
for (int i = 0; i < glowCount; ++i) {{
  int k = {fields} * i;
  vec3 w = vec3(glowLights[k + 1], glowLights[k + 2], glowLights[k + 3]);
  float strength = 1.0;
  if (glowLights[k] != 0.0) {{
    w -= {place};
    float square = dot(w, w);
    w *= inversesqrt(max(square, 1e-30));
    vec3 axis = vec3(glowLights[k + 4], glowLights[k + 5], glowLights[k + 6]);
    strength = square > 0.0 && -dot(w, axis) >= glowLights[k + 7] ? 1.0 / square : 0.0;
  }}
  vec3 color = strength * vec3(glowLights[k + 8], glowLights[k + 9], glowLights[k + 10]);
{sum}}}
"""
# IEC 61966-2-1, as in lutcore.color.
_SEEN = """
vec3 glowView = glowEye[3] > 0.0
  ? normalize(vec3(glowEye[0], glowEye[1], glowEye[2]) - {place})
  : vec3(glowEye[0], glowEye[1], glowEye[2]);
float glowSlant = abs(dot({leaving}, glowView));
vec3 glowExit = vec3({entering});
glowShone = clamp(glowExposure * glowExit * glowShone{albedo}, 0.0, 1.0);
vec3 glowPower = 1.055 * pow(glowShone, vec3(1.0 / 2.4)) - 0.055;
gl_FragData[0] = vec4(mix(12.92 * glowShone, glowPower, step(0.0031308, glowShone)), 1.0);
"""


def passed(look: PixelLook) -> tuple[str, str, str]:
    """Return how attributes come from the vertices to the pixels.

    Parameters
    ----------
    look : PixelLook
        Names them.

    Returns
    -------
    tuple of str
        Declarations and code of the vertex shader, declarations of the fragment shader.
    """
    names = list(look.attributes)
    declared = "".join(f"in vec3 {name};\nout vec3 {_out(name)};\n" for name in names)
    done = "".join(f"{_out(name)} = {name};\n" for name in names)
    taken = "".join(f"in vec3 {_out(name)};\n" for name in names)
    return (
        f"{declared}out vec3 {_PLACE};\n",
        f"{done}{_PLACE} = vertexMC.xyz;\n",
        f"{taken}in vec3 {_PLACE};\n",
    )


def functions(look: PixelLook) -> str:
    """Return what the fragment shader needs before its main function.

    Parameters
    ----------
    look : PixelLook
        The model.

    Returns
    -------
    str
        GLSL.
    """
    if look.table is None:
        return _TRANSMITTANCE
    last = str(look.table.shape[1] - 1)
    curved = _CURVED.replace("{hinges}", str(look.hinges)).replace("{last}", last)
    curved = curved.replace("{half}", f"{1.0 / HALF}")
    return _TRANSMITTANCE + curved


def color(look: PixelLook) -> str:
    """Return the code that gives a pixel its colour.

    Parameters
    ----------
    look : PixelLook
        The model.

    Returns
    -------
    str
        GLSL.
    """
    channels = range(3 if look.by_channel else 1)
    before = "".join(f"vec3 n{c} = glowUnit({_out(f'facing{c}')});\n" for c in channels)
    leaving = "n0"
    if "leaving" in look.attributes:
        leaving = f"glowUnit({_out('leaving')})"
    albedo = f" * {_out('albedo')}" if "albedo" in look.attributes else ""
    total = "glowShone *= vec3(glowTotal[0], glowTotal[1], glowTotal[2]);\n"
    if look.table is not None:
        total += "".join(
            f"glowShone[{c}] /= 1.0 + glowArea[{c}] * {_called('glowArea2', look, c)};\n"
            for c in range(3)
        )
    light = _LIGHT.format(fields=LIGHT_FIELDS, place=_PLACE, sum=_sum(look))
    # The constructor of a vector takes one number for all three.
    indices = range(3 if len(set(look.numbers["glowEta"])) > 1 else 1)
    entering = ", ".join(f"glowEntering(glowSlant, glowEta[{c}])" for c in indices)
    seen = _SEEN.format(place=_PLACE, leaving=leaving, albedo=albedo, entering=entering)
    return before + light + total + seen


def room() -> int:
    """Return how many numbers the uniform of the lights holds.

    Returns
    -------
    int
        `LIGHT_FIELDS` for each light.
    """
    return MOST_LIGHTS * LIGHT_FIELDS


def _sum(look: PixelLook) -> str:
    lines = []
    for c in range(3):
        own = c if look.by_channel else 0
        cosine = f"dot(n{own}, w)"
        if look.table is None:
            factor = f"max({cosine}, 0.0)"
            if look.directional:
                factor += f" * glowEntering(max({cosine}, 0.0), glowEta[{c}])"
        else:
            factor = f"glowOf({cosine}, {_called('glowBending', look, c, 'w')}, {c})"
        lines.append(f"  if (color[{c}] > 0.0) glowShone[{c}] += color[{c}] * {factor};\n")
    return "".join(lines)


def _called(function: str, look: PixelLook, channel: int, *more: str) -> str:
    own = channel if look.by_channel else 0
    arguments = (_out(f"spread{own}"), _out(f"twist{own}"), *more)
    return f"{function}({', '.join(arguments)})"


def _out(name: str) -> str:
    return f"{name}Glow"
