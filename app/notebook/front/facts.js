// What follows from the arrays and is drawn: boundary loops, irregular vertices, folded elements.
//
// All of it is found again after each change, in one pass over the arrays: well under a millisecond
// for 10,000 elements, so that nothing has to be kept up.

const FLAT_SINE = 1e-5;
const SAMPLES = 1500;
const NEAR_RINGS = 5;

class Facts {
  constructor(mirror) {
    this.loops = boundaryLoops(mirror);
    this.irregular = verticesWith(mirror, (v) => mirror.delta[v] !== 0);
    this.corners = verticesWith(mirror, (v) => (mirror.flags[v] & FLAG_CORNER) !== 0);
    this.locked = verticesWith(mirror, (v) => (mirror.flags[v] & FLAG_LOCKED) !== 0);
    this.typical = typicalEdge(mirror);
    this.reach = shortestEdges(mirror);
    this.apart = distancesApart(mirror, this.irregular, this.typical);
    this.inverted = invertedElements(mirror);
  }
}

function verticesWith(mirror, test) {
  const found = [];
  for (let v = 0; v < mirror.vertices; v += 1) {
    if (mirror.flags[v] & FLAG_ALIVE && test(v)) found.push(v);
  }
  return found;
}

/** Boundary loops as arrays of vertex ids. */
function boundaryLoops(mirror) {
  const from = new Map();
  for (let h = 0; h < mirror.halfedges; h += 1) {
    if (mirror.twin[h] < 0 && mirror.origin[h] >= 0) from.set(mirror.origin[h], h);
  }
  const loops = [];
  while (from.size) {
    const loop = [];
    let h = from.values().next().value;
    while (h !== undefined) {
      from.delete(mirror.origin[h]);
      loop.push(mirror.origin[h]);
      h = from.get(mirror.target(h));
    }
    loops.push(loop);
  }
  return loops;
}

/** The median length of an edge, of a sample of them. */
function typicalEdge(mirror) {
  const step = Math.max(1, Math.floor(mirror.halfedges / SAMPLES));
  const lengths = [];
  for (let h = 0; h < mirror.halfedges; h += step) {
    if (mirror.origin[h] >= 0) lengths.push(edgeLength(mirror, h));
  }
  lengths.sort((a, b) => a - b);
  return lengths.length ? lengths[lengths.length >> 1] : 1;
}

function edgeLength(mirror, h) {
  const [a, b] = [2 * mirror.origin[h], 2 * mirror.target(h)];
  return Math.hypot(mirror.places[b] - mirror.places[a], mirror.places[b + 1] - mirror.places[a + 1]);
}

/** Length of the shortest edge at every irregular vertex, by vertex id. */
function shortestEdges(mirror) {
  const shortest = new Float32Array(mirror.vertices).fill(Infinity);
  for (let h = 0; h < mirror.halfedges; h += 1) {
    if (mirror.origin[h] < 0) continue;
    const [a, b] = [mirror.origin[h], mirror.target(h)];
    if (mirror.delta[a] === 0 && mirror.delta[b] === 0) continue;
    const length = edgeLength(mirror, h);
    if (length < shortest[a]) shortest[a] = length;
    if (length < shortest[b]) shortest[b] = length;
  }
  return shortest;
}

/** How far the nearest other of `vertices` is from each, by vertex id; at most some edges. */
function distancesApart(mirror, vertices, typical) {
  const cell = 1.5 * typical;
  const key = (i, j) => i * 65536 + j;
  const cells = new Map();
  const at = (v, axis) => Math.floor(mirror.places[2 * v + axis] / cell) + 32768;
  for (const v of vertices) {
    const here = key(at(v, 0), at(v, 1));
    if (cells.has(here)) cells.get(here).push(v);
    else cells.set(here, [v]);
  }
  const apart = new Map();
  for (const v of vertices) {
    let nearest = Infinity;
    let ring = 0;
    for (; ring < NEAR_RINGS && nearest > (ring - 1) * cell; ring += 1) {
      for (let i = -ring; i <= ring; i += 1) {
        const edge = Math.abs(i) === ring;
        for (let j = -ring; j <= ring; j += edge ? 1 : 2 * ring) {
          for (const u of cells.get(key(at(v, 0) + i, at(v, 1) + j)) || []) {
            if (u === v) continue;
            const away = Math.hypot(
              mirror.places[2 * u] - mirror.places[2 * v],
              mirror.places[2 * u + 1] - mirror.places[2 * v + 1],
            );
            if (away < nearest) nearest = away;
          }
          if (ring === 0) break;
        }
      }
    }
    apart.set(v, Math.min(nearest, ring * cell));
  }
  return apart;
}

/** Elements with a corner that is flat or turns the wrong way, as meshcore.quality.inverted. */
function invertedElements(mirror) {
  const { k, places, origin } = mirror;
  const found = [];
  for (let e = 0; e < mirror.elements; e += 1) {
    if (origin[k * e] < 0) continue;
    for (let i = 0; i < k; i += 1) {
      const a = 2 * origin[k * e + ((i + k - 1) % k)];
      const b = 2 * origin[k * e + i];
      const c = 2 * origin[k * e + ((i + 1) % k)];
      const [ux, uy] = [places[c] - places[b], places[c + 1] - places[b + 1]];
      const [vx, vy] = [places[a] - places[b], places[a + 1] - places[b + 1]];
      const limit = FLAT_SINE * Math.sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
      if (ux * vy - uy * vx <= limit) {
        found.push(e);
        break;
      }
    }
  }
  return found;
}
