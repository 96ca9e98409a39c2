// A run at work: poses come as server-sent events, each a line of JSON, and word of new overlays, which are then fetched.
(() => {
  const setup = JSON.parse(document.getElementById("player-data").textContent);
  const player = makePlayer(document.getElementById("player"), 0, { ...setup.player, live: true });
  const state = document.querySelector(".state");
  const value = name => document.querySelector(`[data-value="${name}"]`);
  const seconds = 30;
  // What came in the last half minute: [when it came, s, confidence, expected error, latency, whether she is lost].
  let poses = [];

  function say(word, kind) {
    state.textContent = word;
    state.className = "state " + kind;
  }
  const mean = values => values.length ? values.reduce((a, b) => a + b, 0) / values.length : NaN;
  const percentile = (values, share) => {
    const sorted = [...values].sort((a, b) => a - b);
    return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : NaN;
  };
  const written = (number, digits) => Number.isFinite(number) ? number.toFixed(digits) : "–";

  const lines = [
    { name: "confidence", at: 1, colour: "#e08a2e", top: () => 1, digits: 2, unit: "" },
    { name: "expected", at: 2, colour: "#1f6fb2", top: most => Math.max(most * 1.15, 50), digits: 0, unit: " mm" },
    { name: "latency", at: 3, colour: "#168c5a", top: most => Math.max(most, setup.deadline || 0) * 1.15 || 10, digits: 1, unit: " ms" },
  ];
  function nice(top) {
    const power = Math.pow(10, Math.floor(Math.log10(top)));
    return [0.2, 0.5, 1, 2, 5].map(k => k * power).filter(step => top / step <= 3.5)[0];
  }
  function drawLine(line, now) {
    const canvas = document.querySelector(`canvas[data-line="${line.name}"]`), pen = canvas.getContext("2d");
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio)) { canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio); }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const left = 46, right = width - 6, high = 6, low = height - 18;
    const top = line.top(poses.reduce((most, pose) => Math.max(most, pose[line.at]), 0));
    const x = time => right - (now - time) / seconds * (right - left), y = v => low - Math.min(v / top, 1) * (low - high);
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    const step = nice(top);
    for (let v = 0; v <= top * 1.001; v += step) {
      pen.strokeStyle = "#e6e9ec";
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(left, y(v));
      pen.lineTo(right, y(v));
      pen.stroke();
      pen.fillStyle = "#66707c";
      pen.fillText(String(+v.toPrecision(6)), left - 6, y(v));
    }
    pen.textBaseline = "alphabetic";
    for (let ago = 0; ago <= seconds; ago += 10) {
      pen.textAlign = ago === 0 ? "right" : ago === seconds ? "left" : "center";
      pen.fillText(ago === 0 ? "now" : "-" + ago + " s", x(now - ago), height - 4);
    }
    if (line.name === "latency" && setup.deadline) {
      pen.setLineDash([5, 4]);
      pen.strokeStyle = "#c83232";
      pen.beginPath();
      pen.moveTo(left, y(setup.deadline));
      pen.lineTo(right, y(setup.deadline));
      pen.stroke();
      pen.setLineDash([]);
    }
    // Where she is lost.
    pen.fillStyle = "rgba(200,50,50,.16)";
    for (const pose of poses) if (pose[4]) pen.fillRect(x(pose[0]) - 1, high, 2, low - high);
    pen.save();
    pen.beginPath();
    pen.rect(left, high - 2, right - left, low - high + 4);
    pen.clip();
    pen.strokeStyle = line.colour;
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    pen.beginPath();
    let before = null;
    for (const pose of poses) {
      // A second without a pose is a gap.
      if (before === null || pose[0] - before > 1) pen.moveTo(x(pose[0]), y(pose[line.at]));
      else pen.lineTo(x(pose[0]), y(pose[line.at]));
      before = pose[0];
    }
    pen.stroke();
    pen.restore();
    const newest = poses.length ? poses[poses.length - 1][line.at] : NaN;
    value("line-" + line.name).textContent = written(newest, line.digits) + (Number.isFinite(newest) ? line.unit : "");
  }
  let isOver = false, stopped = 0;
  function draw() {
    const now = isOver ? stopped : performance.now() / 1000;
    poses = poses.filter(pose => now - pose[0] <= seconds);
    const recent = poses.filter(pose => now - pose[0] <= 2);
    const span = poses.length ? Math.min(2, now - poses[0][0]) : 0;
    value("rate").textContent = span < 1 ? "–" : written(recent.length / span, 1);
    value("latency").textContent = written(percentile(recent.map(pose => pose[3]), 0.5), 1) + " ms";
    value("slowest").textContent = written(percentile(poses.map(pose => pose[3]), 0.99), 1) + " ms";
    value("confidence").textContent = written(mean(recent.map(pose => pose[1])), 2);
    value("expected").textContent = written(mean(recent.map(pose => pose[2])), 0) + " mm";
    lines.forEach(line => drawLine(line, now));
  }
  setInterval(draw, 200);
  draw();

  const source = new EventSource("events");
  source.addEventListener("open", () => say("waiting for a pose", ""));
  source.addEventListener("error", () => { if (!isOver) say("not connected", "off"); });
  source.addEventListener("pose", event => {
    const pose = JSON.parse(event.data);
    const sigmas = Object.values(pose.sigma).filter(Number.isFinite);
    poses.push([performance.now() / 1000, pose.confidence, mean(sigmas), pose.latency, pose.lost]);
    player.push(pose.frame, setup.joints.map(name => pose.joints[name] || null));
    if (pose.lost) say("person lost", "lost"); else say("live", "on");
  });
  source.addEventListener("views", event => {
    document.querySelectorAll("#overlays img").forEach((img, view) => {
      // Shown when it is there, so that nothing flickers.
      const next = new Image();
      next.onload = () => { img.src = next.src; };
      next.src = "view/" + view + "?" + event.data;
    });
    value("shown").textContent = "frame " + event.data;
  });
  source.addEventListener("end", () => {
    draw();
    isOver = true;
    stopped = performance.now() / 1000;
    source.close();
    say("the run has ended", "");
  });
})();
