// Appearance: palettes, and the GLSL programs of diffuse surfaces, particles, lines and the floor.

// Linear colours, the same as in still pictures.
const CLOTHS = [
  [0.5, 0.085, 0.07], [0.065, 0.21, 0.38], [0.66, 0.37, 0.07],
  [0.07, 0.3, 0.22], [0.4, 0.18, 0.42], [0.3, 0.42, 0.12],
];
const COLLIDERS = [[0.3, 0.3, 0.295], [0.25, 0.27, 0.29], [0.33, 0.3, 0.26]];

// Strain in units of the full scale: -1 shorter, 0, +1 longer.
export const STRAIN = [
  [0.02, 0.12, 0.42], [0.18, 0.46, 0.66], [0.72, 0.71, 0.67], [0.86, 0.42, 0.13], [0.52, 0.02, 0.05],
];

// Contact states, by the byte of the cache. A higher one is worse.
export const CONTACT_STATES = ["free", "touching", "compressed", "depenetrating", "intersecting"];
export const CONTACT_STATE_COLOURS = [
  [0.45, 0.45, 0.43], [0.07, 0.3, 0.62], [0.9, 0.42, 0.03], [0.5, 0.03, 0.5], [0.7, 0.01, 0.02],
];

// The colour of picked points.
export const PICK_COLOUR = [0.35, 1, 0.75];

// The colour of each object, by its order among cloths or among colliders.
export function objectColours(objects) {
  const counts = { cloth: 0, collider: 0 };
  return objects.map(({ topology }) => {
    const group = topology.kind === "collider" ? "collider" : "cloth";
    const colours = group === "collider" ? COLLIDERS : CLOTHS;
    counts[group] += 1;
    return colours[(counts[group] - 1) % colours.length];
  });
}

// A linear colour in CSS.
export function css(colour) {
  return `rgb(${colour.map((x) => Math.round(255 * Math.sqrt(Math.min(1, x)))).join(" ")})`;
}

const HEAD = `#version 300 es
precision highp float;
precision highp sampler2DShadow;
uniform mat4 view, projection, light;
uniform vec3 eye, toKey;
`;

// The fraction of the key light that reaches a point: percentage-closer filtering over 3 x 3 cells.
const SHADOW = `
uniform sampler2DShadow depths;
uniform float cell;
float keyVisibility(vec3 at, vec3 normal) {
  vec3 inLight = (light * vec4(at + normal * cell * 2.5, 1.0)).xyz * 0.5 + 0.5;
  if (any(lessThan(inLight, vec3(0.0))) || any(greaterThan(inLight, vec3(1.0)))) return 1.0;
  vec2 step = 1.5 / vec2(textureSize(depths, 0));
  float sum = 0.0;
  for (int y = -1; y <= 1; y++)
    for (int x = -1; x <= 1; x++)
      sum += texture(depths, vec3(inLight.xy + vec2(x, y) * step, inLight.z));
  return sum / 9.0;
}
vec3 diffuse(vec3 colour, vec3 normal, float key) {
  vec3 sky = vec3(0.29, 0.31, 0.35) * (0.62 + 0.38 * normal.y);
  vec3 below = vec3(0.06, 0.055, 0.05) * (0.5 - 0.5 * normal.y);
  return colour * (vec3(1.04, 1.0, 0.94) * max(dot(normal, toKey), 0.0) * key + sky + below);
}
`;

// The colour of a scalar in units of the full scale.
const SCALAR = `
uniform vec3 ramp[5];
uniform float fullScale, isCategorical;
vec3 scalarColour(float scalar) {
  float place = clamp(scalar / fullScale, -1.0, 1.0) * 2.0 + 2.0;
  int low = min(int(place), 3);
  return mix(ramp[low], ramp[low + 1], place - float(low));
}
vec3 categoryColour(float value) {
  return ramp[clamp(int(value + 0.5), 0, 4)];
}
`;

export const SURFACE = {
  vertex: `${HEAD}${SCALAR}
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float value;
out vec3 at, facing, tint;
out float scalar;
void main() {
  at = position; facing = normal; scalar = value;
  tint = categoryColour(value); // categories are not interpolated, only their colours
  gl_Position = projection * view * vec4(position, 1.0);
}`,
  fragment: `${HEAD}${SHADOW}${SCALAR}
uniform vec3 colour;
in vec3 at, facing, tint;
in float scalar;
out vec4 shown;
void main() {
  vec3 ray = normalize(at - eye);
  vec3 normal = normalize(facing);
  bool isBack = !gl_FrontFacing;
  if (isBack) normal = -normal;
  vec3 base = isCategorical > 0.0 ? tint : fullScale > 0.0 ? scalarColour(scalar) : colour;
  if (isBack) base *= 0.72;
  float key = keyVisibility(at, normal);
  float grazing = 1.0 - min(abs(dot(ray, normal)), 1.0);
  vec3 sheen = (base * 0.5 + 0.03) * grazing * grazing * grazing * (0.25 + 0.75 * key) * 0.5;
  shown = vec4(sqrt(diffuse(base, normal, key) + sheen), 1.0);
}`,
};

export const LINES = {
  vertex: `${HEAD}
layout(location = 0) in vec3 position;
void main() {
  gl_Position = projection * view * vec4(position, 1.0);
  gl_Position.z -= 2e-4 * gl_Position.w; // in front of their faces
}`,
  fragment: `${HEAD}
out vec4 shown;
uniform vec4 ink;
void main() { shown = ink; }`,
};

// A disc per particle, shaded as a ball. `size` is the factor on the radius and the opacity. A quantity that colours
// replaces the colour and the light of a particle.
export const PARTICLES = {
  vertex: `${HEAD}${SCALAR}
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 size;
layout(location = 2) in vec3 own;
layout(location = 3) in vec3 given;
layout(location = 4) in float value;
uniform vec3 colour;
uniform float radius, pixels;
out vec3 tint, glow;
out float opacity;
void main() {
  bool isColoured = isCategorical > 0.0 || fullScale > 0.0;
  tint = isCategorical > 0.0 ? categoryColour(value) : fullScale > 0.0 ? scalarColour(value)
    : own.r < 0.0 ? colour : own; // below 0: no colour of its own
  glow = isColoured ? vec3(0.0) : given; opacity = size.y;
  gl_Position = size.x > 0.0 ? projection * view * vec4(position, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = max(2.0, size.x * radius * projection[1][1] * pixels / gl_Position.w);
}`,
  fragment: `${HEAD}
in vec3 tint, glow;
in float opacity;
out vec4 shown;
void main() {
  vec2 from = gl_PointCoord * 2.0 - 1.0;
  float height = 1.0 - dot(from, from);
  if (height < 0.0) discard;
  vec3 normal = transpose(mat3(view)) * vec3(from.x, -from.y, sqrt(height));
  float sky = 0.3 * (0.7 + 0.3 * normal.y);
  shown = vec4(sqrt(tint * (max(dot(normal, toKey), 0.0) + sky) + glow), opacity);
}`,
};

// The colours of selections, which differ from those of objects.
export const SELECTION_COLOURS = [[1, 0.75, 0.1], [0.25, 0.8, 1], [0.6, 0.95, 0.35], [1, 0.45, 0.85]];

export const DOTS = {
  vertex: `${HEAD}
layout(location = 0) in vec3 position;
uniform float size;
void main() {
  gl_Position = projection * view * vec4(position, 1.0);
  gl_Position.z -= 1e-3 * gl_Position.w; // in front of their faces
  gl_PointSize = size;
}`,
  fragment: `${HEAD}
uniform vec3 colour;
out vec4 shown;
void main() {
  vec2 from = gl_PointCoord * 2.0 - 1.0;
  float far = dot(from, from);
  if (far > 1.0) discard;
  shown = vec4(colour * (far > 0.55 ? 0.25 : 1.0), 1.0);
}`,
};

// The floor is a large square that fades into the background; `across` and `along` are the directions of its grid lines.
export const FLOOR = {
  vertex: `${HEAD}
uniform vec3 centre, across, along;
uniform float reach;
out vec3 at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  at = centre + (across * corner.x + along * corner.y) * reach;
  gl_Position = projection * view * vec4(at, 1.0);
}`,
  fragment: `${HEAD}${SHADOW}
uniform vec3 centre, across, along, upright, background;
uniform float reach, spacing;
in vec3 at;
out vec4 shown;
void main() {
  vec2 place = vec2(dot(at, across), dot(at, along)) / spacing;
  vec2 width = fwidth(place);
  vec2 off = abs(fract(place - 0.5) - 0.5) / max(width, 0.012);
  float line = max(1.0 - off.x, 1.0 - off.y) * clamp(0.12 / max(width.x, width.y), 0.0, 1.0);
  float far = length(at - centre) / reach;
  vec3 colour = diffuse(vec3(0.05, 0.053, 0.058), upright, keyVisibility(at, upright));
  colour *= 1.0 + 0.6 * clamp(line, 0.0, 1.0);
  float opacity = 1.0 - smoothstep(0.12, 0.9, far);
  // From below the floor is transparent.
  shown = vec4(sqrt(mix(background, colour, opacity)), dot(eye - at, upright) < 0.0 ? opacity * 0.3 : opacity);
}`,
};

export const DEPTH = {
  vertex: `${HEAD}
layout(location = 0) in vec3 position;
void main() { gl_Position = light * vec4(position, 1.0); }`,
  fragment: `${HEAD}
void main() {}`,
};
