// WebGL2: context, programs, vertex arrays, and the depth target of the shadow map.

import { PlayerError } from "./source.js";

export function context(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
  if (!gl) {
    throw new PlayerError("This browser offers no WebGL2.", "Use a current browser, or enable hardware acceleration.");
  }
  return gl;
}

// A program, and its uniforms by name.
export function program(gl, vertexText, fragmentText) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
    const logs = gl.getAttachedShaders(made).map((shader) => gl.getShaderInfoLog(shader));
    throw new PlayerError("The graphics driver rejects a shader.", [gl.getProgramInfoLog(made), ...logs].join(" "));
  }
  const uniforms = {};
  for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); k += 1) {
    const { name } = gl.getActiveUniform(made, k);
    uniforms[name] = gl.getUniformLocation(made, name);
  }
  return { made, uniforms };
}

// Vertices as columns of floats. `components` has the size of each column; its index is the attribute location.
export class VertexArray {
  constructor(gl, components) {
    this.gl = gl;
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    this.columns = components.map((size, place) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
      return buffer;
    });
    this.indices = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bindVertexArray(null);
  }

  set(column, values) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.columns[column]);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
  }

  // Stores lists of indices one after the other in one buffer.
  setIndices(lists) {
    const { gl } = this;
    this.ranges = [];
    let length = 0;
    for (const list of lists) {
      this.ranges.push({ offset: 4 * length, count: list.length });
      length += list.length;
    }
    const all = new Uint32Array(length);
    lists.forEach((list, k) => all.set(list, this.ranges[k].offset / 4));
    gl.bindVertexArray(this.array);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, all, gl.DYNAMIC_DRAW);
    gl.bindVertexArray(null);
  }

  draw(mode, list) {
    const { offset, count } = this.ranges[list];
    this.gl.bindVertexArray(this.array);
    this.gl.drawElements(mode, count, this.gl.UNSIGNED_INT, offset);
  }

  delete() {
    [...this.columns, this.indices].forEach((buffer) => this.gl.deleteBuffer(buffer));
    this.gl.deleteVertexArray(this.array);
  }
}

// A square depth texture for a shadow map.
export function depthTarget(gl, side) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, side, side);
  const options = {
    [gl.TEXTURE_MIN_FILTER]: gl.LINEAR, [gl.TEXTURE_MAG_FILTER]: gl.LINEAR,
    [gl.TEXTURE_WRAP_S]: gl.CLAMP_TO_EDGE, [gl.TEXTURE_WRAP_T]: gl.CLAMP_TO_EDGE,
    [gl.TEXTURE_COMPARE_MODE]: gl.COMPARE_REF_TO_TEXTURE, [gl.TEXTURE_COMPARE_FUNC]: gl.LEQUAL,
  };
  Object.entries(options).forEach(([name, value]) => gl.texParameteri(gl.TEXTURE_2D, Number(name), value));
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, frame, side };
}
