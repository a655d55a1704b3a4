// Comparison of two runs: the distances between their points, and the scale that fits them.

// Frames of which the scale is fitted.
const SAMPLES = 9;

// The distance between each simulated point of two states of the same objects, sorted. Objects with other numbers of
// points do not correspond.
export function distances(objects, own, other) {
  const all = [];
  objects.forEach(({ mesh, name }, k) => {
    const twin = other.names.indexOf(name);
    const [a, b] = [own.positions[k], other.positions[twin]];
    if (mesh.kind === "collider" || !a || !b || a.length !== b.length) {
      return;
    }
    for (let at = 0; at < a.length; at += 3) {
      const distance = Math.hypot(a[at] - b[at], a[at + 1] - b[at + 1], a[at + 2] - b[at + 2]);
      if (Number.isFinite(distance)) {
        all.push(distance);
      }
    }
  });
  return Float64Array.from(all).sort();
}

// The value below which a share of sorted values lies; 0 for none.
export function percentile(sorted, share) {
  return sorted.length === 0 ? 0 : sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}

// The 99th percentile of the distances over a few frames of the run.
export async function fittedScale(player) {
  const { cache } = player.timeline;
  const last = cache.frames.length - 1;
  const frames = Array.from({ length: SAMPLES }, (_, k) => Math.round((last * (k + 1)) / SAMPLES));
  let largest = 0;
  for (const index of new Set(frames)) {
    const own = await cache.state(index).catch(() => null);
    const other = own && (await player.twinOf(cache, own).catch(() => null));
    if (other) {
      largest = Math.max(largest, percentile(distances(player.scene.objects, own, other), 0.99));
    }
  }
  return largest;
}
