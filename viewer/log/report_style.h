// How a report looks, and what moves in it.
#pragma once

namespace tenebra::viewer {

// Colours of stages can be told apart in both modes, by lightness too.
inline constexpr const char* report_style = R"(
:root { color-scheme: light dark; --page: #fff; --text: #1d2127; --dim: #5b6472; --grid: #e3e6ea; --box: #f5f6f8;
  --a: #0b62c4; --b: #c2410c; --mark: #fff3c4;
  --s0: #4e79a7; --s1: #f0a04b; --s2: #59a14f; --s3: #b07aa1; --s4: #d65f5f; --s5: #76b7b2; --s6: #8c6d46;
  --s7: #d9c04a; --s8: #f29bb2; --s9: #a7adb5; }
@media (prefers-color-scheme: dark) { :root { --page: #14171b; --text: #e6e9ed; --dim: #9aa4b2; --grid: #2b3038;
  --box: #1c2026; --a: #6cb0ff; --b: #ff9a5c; --mark: #4a3f12;
  --s0: #6c9bd1; --s2: #6dbb62; --s3: #c695b8; --s6: #b08d5f; --s9: #6b7280; } }
body { margin: 0 auto; max-width: 1020px; padding: 24px 16px 48px; background: var(--page); color: var(--text);
  font: 15px/1.45 system-ui, sans-serif; }
h1 { font-size: 24px; margin: 0 0 4px; } h2 { font-size: 18px; margin: 36px 0 8px; }
p { margin: 6px 0; } .dim { color: var(--dim); } .a { color: var(--a); } .b { color: var(--b); }
svg { display: block; width: 100%; height: auto; background: var(--box); border-radius: 6px; }
svg text { fill: var(--dim); font: 12px system-ui, sans-serif; } svg .label { fill: var(--text); }
.grid { stroke: var(--grid); } .axis { stroke: var(--dim); } .tip { fill: transparent; }
.tip:hover { fill: var(--dim); fill-opacity: 0.15; }
polyline { fill: none; stroke-width: 1.6; stroke-linejoin: round; }
.line0 { stroke: var(--a); } .line1 { stroke: var(--b); } .dot0 { fill: var(--a); } .dot1 { fill: var(--b); }
.ring0, .ring1 { fill: var(--page); stroke-width: 1.6; } .ring0 { stroke: var(--a); } .ring1 { stroke: var(--b); }
.stage0 { fill: var(--s0); background: var(--s0); } .stage1 { fill: var(--s1); background: var(--s1); }
.stage2 { fill: var(--s2); background: var(--s2); } .stage3 { fill: var(--s3); background: var(--s3); }
.stage4 { fill: var(--s4); background: var(--s4); } .stage5 { fill: var(--s5); background: var(--s5); }
.stage6 { fill: var(--s6); background: var(--s6); } .stage7 { fill: var(--s7); background: var(--s7); }
.stage8 { fill: var(--s8); background: var(--s8); } .stage9 { fill: var(--s9); background: var(--s9); }
.legend { margin: 6px 0 8px; } .legend span { margin-right: 16px; white-space: nowrap; }
.legend i { display: inline-block; width: 12px; height: 12px; border-radius: 2px; margin-right: 5px;
  vertical-align: -1px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; } td, th { padding: 3px 10px; text-align: right; white-space: nowrap;
  border-bottom: 1px solid var(--grid); font-variant-numeric: tabular-nums; }
th { font-weight: 600; } td:first-child, th:first-child { text-align: left; padding-left: 0; }
.settings td { text-align: left; white-space: normal; overflow-wrap: anywhere; vertical-align: top; }
.settings td:first-child { white-space: nowrap; } .differs td { background: var(--mark); } .total td { font-weight: 600; }
.strip { display: flex; flex-wrap: wrap; gap: 8px; margin-top: 10px; }
.strip button { border: 2px solid transparent; border-radius: 6px; padding: 2px; background: none; color: var(--dim);
  font: 12px system-ui, sans-serif; cursor: pointer; } .strip button[aria-pressed=true] { border-color: var(--a); }
.strip img { display: block; width: 148px; height: auto; border-radius: 3px; }
.view { position: relative; } .pictures { max-width: 800px; } .view img { display: block; width: 100%; height: auto; border-radius: 6px; }
.view .over { position: absolute; inset: 0; clip-path: inset(0 0 0 var(--cut)); }
.view .cut { position: absolute; top: 0; bottom: 0; left: var(--cut); border-left: 2px solid #fff;
  box-shadow: 0 0 2px #000; } input[type=range] { width: 100%; margin: 8px 0 0; accent-color: var(--a); }
.sides { display: flex; justify-content: space-between; }
@media print { .tip { display: none; } }
)";

inline constexpr const char* report_script = R"(
const view = document.querySelector('.view'), over = document.querySelector('.over');
const slider = document.querySelector('input[type=range]'), buttons = [...document.querySelectorAll('.strip button')];
function cut() { view.style.setProperty('--cut', slider.value + '%'); }
function show(button) {
  const pictures = button.querySelectorAll('img');
  view.querySelector('img').src = pictures[0].src;
  if (over) over.src = pictures[1].src;
  document.querySelector('.which').textContent = button.textContent.trim();
  for (const other of buttons) other.setAttribute('aria-pressed', other === button);
}
for (const button of buttons) button.addEventListener('click', () => show(button));
if (slider) { slider.addEventListener('input', cut); cut(); }
if (buttons.length) show(buttons[Math.floor(buttons.length / 2)]);
)";

}  // namespace tenebra::viewer
