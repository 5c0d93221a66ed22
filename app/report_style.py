"""How a report looks: light and dark, on a screen and on paper."""

STYLE = """
:root { --ink: #1b1f24; --soft: #5c6670; --line: #d5dae0; --ground: #ffffff; --raised: #f4f6f8; }
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #dde1e6; --soft: #98a2ad; --line: #3a414a; --ground: #20242a; --raised: #282d34; }
}
* { box-sizing: border-box; }
body { max-width: 1180px; margin: 0 auto; padding: 24px; background: var(--ground);
  color: var(--ink); font: 14px/1.45 system-ui, "Segoe UI", Roboto, Helvetica, Arial, sans-serif; }
h1 { font-size: 24px; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 16px; margin: 22px 0 6px; }
p { margin: 6px 0; }
header p, footer, section > p { color: var(--soft); }
figure { margin: 0; }
img { display: block; width: 100%; height: auto; }
img.dark { display: none; }
@media screen and (prefers-color-scheme: dark) {
  img.light { display: none; }
  img.dark { display: block; }
}
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(200px, 1fr)); gap: 10px;
  margin: 14px 0; }
.tiles div { background: var(--raised); border-radius: 8px; padding: 10px 14px; }
.tiles b { display: block; font-size: 19px; }
.tiles span { color: var(--soft); font-size: 12.5px; }
.histograms svg { display: block; width: 100%; height: auto; }
.beside { display: grid; grid-template-columns: 3fr 2fr; gap: 20px; align-items: center; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th { font-weight: 500; text-align: left; }
td, thead th { text-align: right; padding: 2px 6px; }
thead th:first-child { text-align: left; }
tbody tr { border-top: 1px solid var(--line); }
tr.group th { padding-top: 10px; font-weight: 600; }
ul { margin: 6px 0; padding-left: 20px; }
footer { margin-top: 22px; border-top: 1px solid var(--line); font-size: 12px;
  overflow-wrap: anywhere; }
pre { white-space: pre-wrap; background: var(--raised); color: var(--ink); padding: 8px 10px;
  border-radius: 6px; }
@media (max-width: 700px) {
  .beside { display: block; }
  .numbers { display: block; overflow-x: auto; }
}
@media print {
  @page { size: A4; margin: 10mm; }
  body { padding: 0; font-size: 8pt; line-height: 1.3; max-width: none; }
  h1 { font-size: 14pt; }
  h2 { font-size: 10pt; margin: 8px 0 3px; break-after: avoid; }
  .tiles { grid-template-columns: repeat(4, 1fr); margin: 6px 0; }
  .tiles div { border: 1px solid var(--line); padding: 5px 8px; }
  .tiles b { font-size: 11pt; }
  .tiles span, footer { font-size: 7pt; }
  td, thead th { padding: 0 5px; }
  tr.group th { padding-top: 5px; }
  .beside { grid-template-columns: 2fr 3fr; }
  figure, .tiles, .beside, .histograms, tbody, footer { break-inside: avoid; }
  footer { margin-top: 8px; }
}
"""
