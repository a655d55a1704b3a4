// The surface of particles: made by the server from the recorded positions, drawn instead of the particles.

// Whether the server can make the surfaces of a cache: it has the same file, and the run has particles.
export function hasSurfaces(cache) {
  return cache.source.url?.startsWith("/cache.mcap") && cache.objects.some(({ topology }) => topology.kind === "particles");
}

// A state with the surface of its particles in place of them. Particles without a surface stay as they are.
export async function withSurfaces(cache, state) {
  const found = await Promise.all(cache.objects.map(({ name }, k) => (
    state.meshes[k].kind === "particles" ? surfaceOf(cache.source.url, name, state) : null
  )));
  const choose = (own, part) => own.map((one, k) => (found[k] ? found[k][part] : one));
  return {
    ...state,
    positions: choose(state.positions, "positions"),
    meshes: choose(state.meshes, "mesh"),
  };
}

async function surfaceOf(url, name, { frame, timeIndex }) {
  const query = new URL(url, location.href).search; // the number of a live run
  const answer = await fetch(`/surface/${encodeURIComponent(name)}/${frame}/${timeIndex}${query}`).catch(() => null);
  if (answer?.status !== 200) {
    return null;
  }
  const bytes = await answer.arrayBuffer();
  const [points, quads] = new Uint32Array(bytes, 0, 2);
  const positions = new Float32Array(bytes, 8, 3 * points);
  const corners = new Uint32Array(bytes, 8 + 12 * points, 4 * quads);
  const starts = Uint32Array.from({ length: quads + 1 }, (_, quad) => 4 * quad);
  // A number of its own in each frame: its points are not those of another frame.
  const mesh = { kind: "surface", points, starts, corners, rest: positions, number: NaN };
  return { positions, mesh };
}
