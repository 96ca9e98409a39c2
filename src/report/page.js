// Overlays: the slider shows one frame's views.
(() => {
  const section = document.getElementById("overlays");
  if (!section) return;
  const frames = [...section.querySelectorAll(".views")];
  const slider = section.querySelector("input"), label = section.querySelector("output");
  slider.addEventListener("input", () => {
    frames.forEach((views, i) => { views.hidden = i !== +slider.value; });
    label.textContent = "frame " + frames[+slider.value].dataset.frame;
  });
})();

// The player plays what the page holds.
(() => {
  const section = document.getElementById("player");
  if (!section) return;
  const [firstFrame, data] = JSON.parse(document.getElementById("player-data").textContent);
  makePlayer(section, firstFrame, data);
})();
