#include "report/page_style.h"

namespace troffer {

// Words are never broken: names break where <wbr> allows it (html_name), hashes and paths anywhere.
const char* const page_style = R"(
:root{color-scheme:light}
body{font:14px/1.4 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:#1b1f24;background:#fff;
 max-width:684px;margin:0 auto;padding:1.5rem}
h1{font-size:1.6rem;margin:0 0 .2rem}h2{font-size:1.2rem;margin:1.6rem 0 .5rem;padding-top:.4rem;
 border-top:2px solid #1b1f24}h3{font-size:1rem;margin:.6rem 0 .2rem}
p{margin:.3rem 0 .6rem}.sub{color:#56606b;font-size:.86rem}
.table{overflow-x:auto}table{border-collapse:collapse;margin:.3rem 0 .8rem;font-size:.84rem}
th,td{text-align:left;padding:.2rem .7rem .2rem 0;border-bottom:1px solid #d5dae0;vertical-align:top}
th{font-weight:600;color:#56606b}td:last-child,th:last-child{padding-right:0}
table.matrix td:nth-child(2){white-space:normal}
table.wide{width:100%}table.dense{font-size:.74rem}table.dense th,table.dense td{padding-right:.45rem}
.n{font-variant-numeric:tabular-nums;white-space:nowrap}
.ask{color:#56606b;white-space:nowrap}.sum td{font-weight:600}
.pass,.fail,.open{font-weight:600;padding:0 .35rem;border-radius:.2rem;white-space:nowrap}
.pass{background:#d9f0dd;color:#0c5a21}.fail{background:#fbdcd8;color:#8a1409}.open{background:#fdeec2;color:#6a4a00}
.result{font-size:1rem;margin:.6rem 0}
figure{margin:.4rem 0 .7rem}figcaption{font-size:.8rem;color:#56606b}
svg{max-width:100%;height:auto;display:block}
.surfaces{display:grid;grid-template-columns:1fr 1fr;column-gap:16px}
section.surface{min-width:0}section.wide{grid-column:1/-1}
.plots{display:grid;grid-template-columns:1fr 1fr;column-gap:16px}.plots>figure{min-width:0}
.types{display:grid;grid-template-columns:1fr 1fr;column-gap:16px}
.type{display:flex;gap:12px;align-items:center;min-width:0}.type svg{flex:none}.type p{font-size:.84rem}
figure.picture img{width:100%;height:auto;display:block}
.pair{display:grid;grid-template-columns:1fr 1fr;column-gap:16px}.pair img{width:100%;height:auto}
code{font-size:.8rem;overflow-wrap:anywhere}.notes{font-size:.86rem;padding-left:1.2rem}.notes li{margin:.12rem 0}
@page{size:A4;margin:14mm}
@media print{body{max-width:none;padding:0;font-size:9.5pt;-webkit-print-color-adjust:exact;
 print-color-adjust:exact}h2,h3,h2+p,.sub{break-after:avoid}h2{margin-top:1.1rem}
 section.surface,figure,tr,.type,.keep{break-inside:avoid}.table{overflow:visible}
 thead{display:table-header-group}}
@media screen and (max-width:600px){.surfaces,.plots,.types,.pair{grid-template-columns:1fr}}
)";

}  // namespace troffer
