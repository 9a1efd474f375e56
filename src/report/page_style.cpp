#include "report/page_style.h"

#include "report/svg_plot.h"

namespace pellucid {

namespace {

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--text:#1b1d20;--faint:#585c62;--line:#cfd2d7;--ground:#fff;--raised:#f4f5f7}
@media screen and (prefers-color-scheme:dark){:root{--text:#e4e5e7;--faint:#9a9da3;--line:#45474b;--ground:#1c1d1f;--raised:#262729}}
body{margin:0 auto;padding:1.5rem;max-width:68rem;background:var(--ground);color:var(--text);font:15px/1.5 system-ui,sans-serif}
h1{font-size:1.6rem;margin:0}h2{font-size:1.2rem;margin:2.2rem 0 .6rem}
p.said{font-size:1.05rem}p.faint,figcaption,small{color:var(--faint)}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(20rem,1fr));gap:1.2rem}
.states{display:grid;grid-template-columns:repeat(auto-fill,minmax(9rem,1fr));gap:.8rem}
figure{margin:0;break-inside:avoid}img,svg{max-width:100%;height:auto;display:block}
.states img{width:100%}.states .answer figcaption{color:var(--text);font-weight:bold}
table{border-collapse:collapse;width:100%}.wide{overflow-x:auto}
th,td{text-align:right;padding:.25rem .6rem;border-bottom:1px solid var(--line);font-variant-numeric:tabular-nums}
th:first-child,td:first-child{text-align:left}table.settings td{text-align:left}
.swatch{display:inline-block;width:.8em;height:.8em;border:1px solid var(--faint);margin-right:.5em;print-color-adjust:exact;-webkit-print-color-adjust:exact}
pre{background:var(--raised);border:1px solid var(--line);padding:.8rem;white-space:pre-wrap;overflow-wrap:anywhere}
a{color:inherit}
@media print{body{max-width:none;padding:0;font-size:10pt}h2{break-after:avoid}}
)";

} // namespace

std::string pageStyle() { return kStyle; }

std::string htmlPage(const std::string& title, const std::string& style, const std::string& body) {
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           escapedXml(title) + "</title>\n<style>" + pageStyle() + style + "</style>\n</head>\n<body>\n" + body +
           "</body>\n</html>\n";
}

} // namespace pellucid
