// Moves boxes, highlights those that are in a pair, and draws them.

override DIMENSIONS: u32;
// The world is this wide; it is 1 high and, in 3D, 1 deep.
override WIDTH: f32;

struct Body {
  center: vec3f,
  half_size: vec3f,
  // The way of a step.
  velocity: vec3f,
}

@group(0) @binding(0) var<storage, read_write> bodies: array<Body>;
@group(0) @binding(1) var<storage, read_write> boxes: array<f32>;

@compute @workgroup_size(256)
fn step_bodies(@builtin(global_invocation_id) id: vec3u) {
  if (id.x >= arrayLength(&bodies)) {
    return;
  }
  var body = bodies[id.x];
  let low = body.half_size;
  let high = vec3f(WIDTH, 1, 1) - low;
  body.center = clamp(body.center + body.velocity, low, high);
  // Away from a wall that it touches.
  body.velocity = select(body.velocity, abs(body.velocity), body.center <= low);
  body.velocity = select(body.velocity, -abs(body.velocity), body.center >= high);
  bodies[id.x] = body;
  for (var axis = 0u; axis < DIMENSIONS; axis++) {
    let at = 2 * DIMENSIONS * id.x + axis;
    boxes[at] = body.center[axis] - body.half_size[axis];
    boxes[at + DIMENSIONS] = body.center[axis] + body.half_size[axis];
  }
}

@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
// What the search reports: how many pairs there are, and how many of them were written.
@group(0) @binding(3) var<storage, read> summary: array<u32>;
// 1 for each box in a pair, and behind the last box how many these are.
@group(0) @binding(4) var<storage, read_write> highlighted: array<atomic<u32>>;

fn highlight(box: u32) {
  if (atomicExchange(&highlighted[box], 1) == 0) {
    atomicAdd(&highlighted[arrayLength(&highlighted) - 1], 1);
  }
}

@compute @workgroup_size(64)
fn highlight_pairs(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u, @builtin(local_invocation_index) thread: u32) {
  let i = (group.y * groups.x + group.x) * 64 + thread;
  if (i < summary[1]) {
    highlight(pairs[i].x);
    highlight(pairs[i].y);
  }
}

struct Look {
  box: vec4f,
  highlighted: vec4f,
  ground: vec4f,
  // The size of a pixel in the world: boxes are drawn at least as large.
  pixel: vec2f,
}

@group(0) @binding(5) var<uniform> look: Look;

struct Corner {
  @builtin(position) position: vec4f,
  @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn corner(@builtin(vertex_index) vertex: u32, @location(0) low: vec3f, @location(1) high: vec3f, @location(2) is_highlighted: u32) -> Corner {
  let side = vec2f(vec2u(vertex & 1, vertex >> 1));
  let at = low.xy + side * max(high.xy - low.xy, look.pixel);
  // In 3D what is nearer is in front, and what is farther is dimmer; in 2D what is highlighted is in front.
  let depth = select(low.z, 0.5 * f32(1 - is_highlighted), DIMENSIONS == 2);
  let color = select(look.box, look.highlighted, is_highlighted == 1);
  return Corner(vec4f(2 * at / vec2f(WIDTH, 1) - 1, depth, 1), mix(color, look.ground, 0.85 * low.z));
}

@fragment
fn paint(corner: Corner) -> @location(0) vec4f {
  return corner.color;
}
