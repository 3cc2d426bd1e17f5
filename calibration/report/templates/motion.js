(async () => {
  const byId = name => document.getElementById(name), shown = byId("motion-view"), failed = byId("motion-failed");
  const bytes = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const fail = words => { failed.textContent = words; failed.hidden = false; shown.hidden = true; };
  if (typeof DecompressionStream === "undefined") {
    fail("This browser cannot show the interactive view. The figures below show the same records.");
    return;
  }
  const stream = new Blob([bytes(byId("plotly-gz").textContent.trim())]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(stream).text();
  document.head.append(script);
  const content = JSON.parse(byId("motion-data").textContent);
  const COLOURS = { measured: "#30343b", simulated: "#d1495b", before: "#8fb4d9", wave: "#2f7f86" };
  const WIDTHS = { measured: 1.6, simulated: 1.1, before: 1 };
  const capital = word => word[0].toUpperCase() + word.slice(1);
  const options = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"] };
  const font = { family: "system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif", size: 12, color: "#22262c" };
  const series = byId("motion-series"), choice = byId("motion-test");
  let test = content.tests[0];

  function values(trace) {
    return Array.from(new Int16Array(bytes(trace.data).buffer), n => n === -32768 ? null : trace.offset + trace.scale * n);
  }

  function drawSeries() {
    const count = test.panels.length, gap = 0.25 / Math.max(count, 2), height = (1 - gap * (count - 1)) / count, traces = [];
    const sources = new Set(test.panels.flatMap(panel => panel.traces.map(trace => trace.name)));
    const layout = { height: 130 * count + 110, margin: { l: 62, r: 14, t: 44, b: 48 }, font, showlegend: sources.size > 1,
      legend: { orientation: "h", x: 0, y: 1, yanchor: "bottom" }, hovermode: "x", dragmode: "zoom",
      plot_bgcolor: "#fff", paper_bgcolor: "#fff",
      xaxis: { title: { text: "Time (s)" }, anchor: count > 1 ? "y" + count : "y", gridcolor: "#e4e6ea", zeroline: false } };
    test.panels.forEach((panel, i) => {
      const top = 1 - i * (height + gap), axis = i ? "y" + (i + 1) : "y";
      layout[i ? "yaxis" + (i + 1) : "yaxis"] = { domain: [Math.max(0, top - height), top], gridcolor: "#e4e6ea",
        zerolinecolor: "#c4c8cf", title: { text: capital(panel.name) + "<br>(" + panel.unit + ")", standoff: 6 }, nticks: 5 };
      for (const trace of panel.traces) {
        const wave = panel.name === "wave" && sources.size === 1;
        const first = !test.panels.slice(0, i).some(other => other.traces.some(one => one.name === trace.name));
        traces.push({ type: "scatter", mode: "lines", name: trace.name, legendgroup: trace.name, showlegend: first,
          visible: trace.name === "before" ? "legendonly" : true, x0: test.start, dx: test.step, y: values(trace),
          line: { color: COLOURS[wave ? "wave" : trace.name], width: WIDTHS[trace.name] }, xaxis: "x", yaxis: axis,
          hovertemplate: "%{y:.4g} " + panel.unit + "<extra>" + trace.name + "</extra>" });
      }
    });
    return Plotly.react(series, traces, layout, options);
  }
  await drawSeries();

  const view = byId("motion-hull");
  let update = () => {};
  if (view && content.hull) {
    const rest = new Float32Array(bytes(content.hull.points).buffer);
    const corners = new Uint16Array(bytes(content.hull.triangles).buffer), count = rest.length / 3;
    const slider = byId("motion-frame"), play = byId("motion-play"), clock = byId("motion-time");
    const source = byId("motion-source"), larger = byId("motion-larger");
    const each = n => Array.from({ length: corners.length / 3 }, (_, k) => corners[3 * k + n]);
    const faces = { i: each(0), j: each(1), k: each(2) };
    let poses = [], timer = null;

    function pose(frame) {
      const size = Number(larger.value), p = poses.slice(6 * frame, 6 * frame + 6).map(v => v * size);
      const [cr, cp, cy] = [3, 4, 5].map(n => Math.cos(p[n] * Math.PI / 180));
      const [sr, sp, sy] = [3, 4, 5].map(n => Math.sin(p[n] * Math.PI / 180));
      const turn = [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]];
      return turn.map((row, n) => Array.from({ length: count }, (_, k) =>
        p[n] + row[0] * rest[3 * k] + row[1] * rest[3 * k + 1] + row[2] * rest[3 * k + 2]));
    }
    function show() {
      const frame = Number(slider.value), [x, y, z] = pose(frame);
      clock.textContent = (test.frames.start + frame * test.frames.step).toFixed(1) + " s";
      return Plotly.restyle(view, { x: [x], y: [y], z: [z] }, [0]);
    }
    function stop() { clearInterval(timer); timer = null; play.textContent = "Play"; }
    function draw() {
      stop();
      const names = Object.keys(test.frames.poses);
      if (!names.includes(source.value)) source.value = names[0];
      for (const option of source.options) option.disabled = !names.includes(option.value);
      poses = Array.from(new Float32Array(bytes(test.frames.poses[source.value]).buffer));
      slider.max = poses.length / 6 - 1;
      slider.value = 0;
      const range = [0, 1, 2].map(() => [Infinity, -Infinity]);
      for (let frame = 0; frame <= slider.max; frame += 1) pose(frame).forEach((row, n) => {
        for (const v of row) { range[n][0] = Math.min(range[n][0], v); range[n][1] = Math.max(range[n][1], v); }
      });
      const room = 0.08 * Math.max(...range.map(([a, b]) => b - a)), ends = range.map(([a, b]) => [a - room, b + room]);
      ends[2] = [Math.min(ends[2][0], -room), Math.max(ends[2][1], room)];
      const height = Math.min(430, Math.max(260, Math.round(0.95 * view.clientWidth)));
      const away = Math.min(1.7, Math.max(1, (1.05 * height) / view.clientWidth));
      const [x, y, z] = pose(0), [[x0, x1], [y0, y1]] = ends;
      const hull = { type: "mesh3d", x, y, z, ...faces, color: "#c3b06a", flatshading: true, hoverinfo: "skip",
        lighting: { ambient: 0.6, diffuse: 0.7, specular: 0.1 } };
      const water = { type: "mesh3d", x: [x0, x1, x1, x0], y: [y0, y0, y1, y1], z: [0, 0, 0, 0], i: [0, 0], j: [1, 2], k: [2, 3],
        color: COLOURS.wave, opacity: 0.3, hoverinfo: "skip" };
      const axis = (name, limits) => ({ title: { text: name + " (m)" }, range: limits, gridcolor: "#e4e6ea", showbackground: false });
      const layout = { height, margin: { l: 0, r: 0, t: 0, b: 0 }, font, paper_bgcolor: "#fff", uirevision: "kept",
        scene: { xaxis: axis("x", ends[0]), yaxis: axis("y", ends[1]), zaxis: axis("z", ends[2]), aspectmode: "data",
          camera: { eye: { x: 0.95 * away, y: -1.85 * away, z: 0.6 * away }, center: { x: 0, y: 0, z: -0.12 } } } };
      return Plotly.react(view, [hull, water], layout, { responsive: true, displaylogo: false }).then(show);
    }
    play.addEventListener("click", () => {
      if (timer) { stop(); return; }
      play.textContent = "Pause";
      timer = setInterval(() => { slider.value = (Number(slider.value) + 1) % (Number(slider.max) + 1); show(); }, 50);
    });
    slider.addEventListener("input", () => { stop(); show(); });
    source.addEventListener("change", draw);
    larger.addEventListener("change", draw);
    update = draw;
    try { await draw(); } catch (error) { byId("motion-platform").hidden = true; }
  }
  choice?.addEventListener("change", () => { test = content.tests[Number(choice.value)]; drawSeries(); update(); });
  document.documentElement.dataset.motion = "drawn";
})();
