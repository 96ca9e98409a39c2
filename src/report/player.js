"use strict";
// The 3D player: perspective by hand on a plain canvas. World in mm, z up. Of a finished track it has every frame and plays them; while a
// run is at work (data.live) frames are pushed to it, of which it keeps the last and shows the newest.
function makePlayer(section, firstFrame, data) {
  const canvas = section.querySelector("canvas"), pen = canvas.getContext("2d");
  const slider = section.querySelector("input[type=range]"), label = section.querySelector("output");
  const play = section.querySelector(".play"), legend = section.querySelector(".legend");
  const beside = section.querySelector(".beside"), trails = section.querySelector(".trails");
  const withCameras = section.querySelector(".cameras");
  const colours = ["#1f6fb2", "#e08a2e"];
  const kept = 900, numbers = [];
  let count = 0;
  function countFrames() {
    count = Math.max(...data.skeletons.map(s => s.frames.length));
    slider.max = Math.max(count - 1, 0);
  }
  countFrames();

  // Colour of a bone: the tracked body in blue, the reference in orange.
  data.skeletons.forEach((s, k) => {
    const key = document.createElement("span"), dash = document.createElement("i");
    dash.style.background = colours[k % colours.length];
    key.append(dash, s.name);
    legend.append(key);
  });
  if (data.skeletons.length < 2) beside.parentElement.hidden = true;
  if (!data.cameras.length) withCameras.parentElement.hidden = true;

  // What the motion fills decides where the eye looks and how far it stands off.
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const start = { turn: -0.9, lift: 0.32, far: 0 };
  let middle, extent, floor, eye, isMoved = false;
  function reach(row) {
    for (const p of row) if (p)
      for (let i = 0; i < 3; i++) { low[i] = Math.min(low[i], p[i]); high[i] = Math.max(high[i], p[i]); }
  }
  function standOff() {
    const [from, to] = low[0] < Infinity ? [low, high] : [[-1000, -1000, 0], [1000, 1000, 1800]];
    middle = from.map((v, i) => (v + to[i]) / 2);
    extent = Math.max(to[0] - from[0], to[1] - from[1], to[2] - from[2], 800);
    floor = from[2] < 700 ? Math.min(0, from[2]) : from[2];
    start.far = extent * 1.75 + 900;
    if (!isMoved) eye = { ...start };
  }
  for (const s of data.skeletons) s.frames.forEach(reach);
  standOff();
  let frame = 0, playing = true, last = 0, owed = 0;

  function project(p) {
    const x = p[0] - middle[0], y = p[1] - middle[1], z = p[2] - middle[2];
    const ct = Math.cos(eye.turn), st = Math.sin(eye.turn), cl = Math.cos(eye.lift), sl = Math.sin(eye.lift);
    const right = -st * x + ct * y, out = ct * x + st * y;
    const up = cl * z - sl * out, depth = eye.far - (cl * out + sl * z);
    if (depth < 50) return null;
    const scale = canvas.clientHeight * 1.25 / depth;
    return [canvas.clientWidth / 2 + right * scale, canvas.clientHeight / 2 - up * scale, depth, scale];
  }
  function line(a, b, width, colour) {
    const p = project(a), q = project(b);
    if (!p || !q) return;
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(p[0], p[1]);
    pen.lineTo(q[0], q[1]);
    pen.stroke();
  }
  function drawFloor() {
    const step = 500, reach = Math.ceil((extent / 2 + 1200) / step) * step;
    const cx = Math.round(middle[0] / step) * step, cy = Math.round(middle[1] / step) * step;
    for (let d = -reach; d <= reach; d += step) {
      const colour = d === 0 ? "#c3cbd3" : "#dde2e7";
      line([cx + d, cy - reach, floor], [cx + d, cy + reach, floor], 1, colour);
      line([cx - reach, cy + d, floor], [cx + reach, cy + d, floor], 1, colour);
    }
  }
  function drawCameras() {
    pen.font = "12px system-ui, sans-serif";
    for (const camera of data.cameras) {
      const ends = camera.corners.map(c => camera.centre.map((v, i) => v + c[i] * 420));
      ends.forEach((end, i) => {
        line(camera.centre, end, 1, "#8b95a1");
        line(end, ends[(i + 1) % 4], 1.4, "#5d6874");
      });
      const p = project(camera.centre);
      if (p) { pen.fillStyle = "#66707c"; pen.fillText(camera.name, p[0] + 6, p[1] - 6); }
    }
  }
  function drawSkeleton(s, colour, shift) {
    const row = s.frames[Math.min(frame, s.frames.length - 1)] || [];
    const at = p => p && [p[0] + shift[0], p[1] + shift[1], p[2]];
    // A shadow on the floor tells where the feet are.
    for (const [a, b] of s.bones) if (row[a] && row[b]) {
      const p = at(row[a]), q = at(row[b]);
      line([p[0], p[1], floor], [q[0], q[1], floor], 4, "rgba(40,50,60,.10)");
    }
    const bones = s.bones.filter(([a, b]) => row[a] && row[b])
      .map(([a, b]) => ({ a: at(row[a]), b: at(row[b]), p: project(at(row[a])), q: project(at(row[b])) }))
      .filter(bone => bone.p && bone.q)
      .sort((m, n) => n.p[2] + n.q[2] - m.p[2] - m.q[2]);
    for (const bone of bones) {
      const width = Math.max(2, 34 * (bone.p[3] + bone.q[3]) / 2);
      line(bone.a, bone.b, width + 2, "rgba(255,255,255,.85)");
      line(bone.a, bone.b, width, colour);
    }
    for (const point of row) if (point) {
      const p = project(at(point));
      if (!p) continue;
      pen.beginPath();
      pen.arc(p[0], p[1], Math.max(1.8, 24 * p[3]), 0, 7);
      pen.fillStyle = "#fff";
      pen.fill();
      pen.lineWidth = 1.2;
      pen.strokeStyle = colour;
      pen.stroke();
    }
    if (trails.checked && s.frames.length > 1) {
      // The first point (the root) leaves a trail on the floor.
      for (let i = Math.max(1, frame - 60); i <= frame && i < s.frames.length; i++) {
        const a = at(s.frames[i - 1][0]), b = at(s.frames[i][0]);
        if (a && b) line([a[0], a[1], floor], [b[0], b[1], floor], 2, colour + "70");
      }
    }
  }
  function draw() {
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    pen.lineCap = "round";
    pen.lineJoin = "round";
    drawFloor();
    if (withCameras.checked) drawCameras();
    // Beside means to the right as seen from here.
    const apart = beside.checked ? 1000 : 0;
    for (let k = data.skeletons.length - 1; k >= 0; k--) {
      const side = k === 0 ? -apart / 2 : apart / 2;
      drawSkeleton(data.skeletons[k], colours[k % colours.length],
        [-Math.sin(eye.turn) * side, Math.cos(eye.turn) * side]);
    }
    slider.value = frame;
    const number = data.live ? numbers[frame] : firstFrame + frame;
    const time = (data.live ? number : frame) / data.fps;
    label.textContent = count ? "frame " + number + ", " + time.toFixed(2) + " s" : "";
    play.innerHTML = playing ? "&#10074;&#10074;" : "&#9654;";
  }
  function tick(now) {
    if (data.live && playing) {
      frame = Math.max(count - 1, 0);
    } else if (playing && count > 1) {
      owed += Math.min(now - last, 200) * data.fps / 1000;
      frame = (frame + Math.floor(owed)) % count;
      owed -= Math.floor(owed);
    }
    last = now;
    draw();
    requestAnimationFrame(tick);
  }
  play.addEventListener("click", () => { playing = !playing; });
  slider.addEventListener("input", () => { playing = false; frame = +slider.value; });
  // Fingers and buttons that are down, and where they were last.
  const touching = new Map();
  function zoom(factor) {
    isMoved = true;
    eye.far = Math.max(600, Math.min(start.far * 4, eye.far * factor));
  }
  const spread = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  canvas.addEventListener("pointerdown", e => {
    canvas.setPointerCapture(e.pointerId);
    touching.set(e.pointerId, [e.clientX, e.clientY]);
  });
  canvas.addEventListener("pointermove", e => {
    const before = touching.get(e.pointerId);
    if (!before) return;
    const apart = touching.size === 2 ? spread([...touching.values()]) : 0;
    touching.set(e.pointerId, [e.clientX, e.clientY]);
    if (touching.size === 2) {
      zoom(Math.max(apart, 1) / Math.max(spread([...touching.values()]), 1));
    } else if (touching.size === 1) {
      isMoved = true;
      eye.turn -= (e.clientX - before[0]) * 0.008;
      eye.lift = Math.max(-0.2, Math.min(1.55, eye.lift + (e.clientY - before[1]) * 0.006));
    }
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
    canvas.addEventListener(end, e => touching.delete(e.pointerId));
  canvas.addEventListener("wheel", e => {
    e.preventDefault();
    zoom(Math.exp(e.deltaY * 0.001));
  }, { passive: false });
  canvas.addEventListener("dblclick", () => { isMoved = false; eye = { ...start }; });
  requestAnimationFrame(tick);
  return {
    // A row of points of the first skeleton, at a frame.
    push(number, row) {
      const frames = data.skeletons[0].frames;
      frames.push(row);
      numbers.push(number);
      if (frames.length > kept) {
        frames.shift();
        numbers.shift();
        frame = Math.max(frame - 1, 0);
      }
      countFrames();
      reach(row);
      standOff();
    },
  };
}
