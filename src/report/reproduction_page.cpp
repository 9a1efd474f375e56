#include "report/reproduction_page.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/round_numbers.h"
#include "base/text.h"
#include "report/page_style.h"
#include "report/svg_plot.h"

namespace pellucid {

namespace {

constexpr const char* kStyle = R"(
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(17rem,1fr));gap:1rem;margin:.8rem 0}
.drawings{display:grid;grid-template-columns:repeat(auto-fill,minmax(24rem,1fr));gap:1rem;margin:.8rem 0}
.pictures img,.drawings img{width:100%}
.contents td:last-child{white-space:nowrap}
section{border-top:1px solid var(--line);margin-top:2rem}
table.settings th{text-align:left}.wide table{width:auto;min-width:50%;margin:.6rem 0}caption{text-align:left;color:var(--faint);padding-bottom:.2rem}
ul.statements{list-style:none;padding:0}ul.statements li{margin:.4rem 0;padding-left:1.6rem;position:relative}
ul.statements li::before{position:absolute;left:0;font-weight:bold;content:"✓"}
ul.statements li.fails::before{content:"✗"}
li.fails b,p.error{color:#c0392b}
@media screen and (prefers-color-scheme:dark){li.fails b,p.error{color:#ff8a7a}}
@media print{section{break-before:auto}}
)";

std::string counted(std::size_t n, const std::string& one) {
    return std::to_string(n) + " " + one + (n == 1 ? "" : "s");
}

std::string timeText(double seconds) {
    if (seconds < 60) return fixedText(seconds, 1) + " s";
    return std::to_string(static_cast<int>(seconds / 60)) + " min " +
           std::to_string(static_cast<int>(std::fmod(seconds, 60))) + " s";
}

/// Of something that is counted, such as steps, without decimals; shares have no unit.
std::string valueText(double value, const std::string& unit) {
    return !unit.empty() && value == std::round(value) ? shortText(value) : figureText(value);
}

std::string withUnit(double value, const std::string& unit) {
    return valueText(value, unit) + (unit.empty() ? "" : " " + unit);
}

std::string differenceText(const ReproducedNumber& n) {
    if (n.unit == "s") return n.thesis > 0 ? "× " + shortText(n.ours / n.thesis) : "";
    const double d = n.ours - n.thesis;
    return (d < 0 ? "−" : "+") + valueText(std::abs(d), n.unit);
}

/// What an item's statements come to, in a few words.
std::string verdictOf(const Reproduction& item) {
    if (!item.error.empty()) return "failed";
    if (item.statements.empty()) return "";
    return std::to_string(item.holding()) + " of " + std::to_string(item.statements.size());
}

std::string element(const std::string& tag, const std::string& text) {
    return "<" + tag + ">" + escapedXml(text) + "</" + tag + ">";
}

std::string htmlRow(const std::vector<std::string>& cells, const std::string& tag) {
    std::string row = "<tr>";
    for (const std::string& cell : cells) row += element(tag, cell);
    return row + "</tr>\n";
}

std::string htmlTable(const ReproducedTable& table) {
    std::string html = "<div class=\"wide\"><table>";
    if (!table.caption.empty()) html += element("caption", table.caption);
    html += htmlRow(table.head, "th");
    for (const auto& row : table.rows) html += htmlRow(row, "td");
    return html + "</table></div>\n";
}

/// Ours beside the thesis's.
ReproducedTable numbersOf(const Reproduction& item, bool withTimes) {
    ReproducedTable table{"", {"", "here", "thesis", "difference"}, {}};
    for (const ReproducedNumber& n : item.numbers)
        if (withTimes || n.unit != "s")
            table.rows.push_back({n.what, withUnit(n.ours, n.unit), withUnit(n.thesis, n.unit), differenceText(n)});
    return table;
}

std::string htmlPicture(const ReproducedPicture& p) {
    const std::string caption = (p.figure.empty() ? "" : p.figure + ": ") + p.caption;
    return "<figure><a href=\"" + escapedXml(p.file) + "\"><img loading=\"lazy\" src=\"" + escapedXml(p.file) +
           "\" alt=\"" + escapedXml(caption) + "\"></a>" + element("figcaption", caption) + "</figure>\n";
}

/// Pictures first, then drawings, which have another shape.
std::string htmlPictures(const Reproduction& item) {
    std::string pictures, drawings;
    for (const ReproducedPicture& p : item.pictures) (p.file.ends_with(".svg") ? drawings : pictures) += htmlPicture(p);
    std::string html;
    if (!pictures.empty()) html += "<div class=\"pictures\">\n" + pictures + "</div>\n";
    if (!drawings.empty()) html += "<div class=\"drawings\">\n" + drawings + "</div>\n";
    return html;
}

/// "§4.3.5", "Appendix A"
std::string sectionText(const std::string& section) {
    return (std::isalpha(static_cast<unsigned char>(section[0])) != 0 ? "Appendix " : "§") + section;
}

std::string htmlStatements(const Reproduction& item) {
    if (item.statements.empty()) return "";
    std::string html = "<h3>What the text says</h3>\n<ul class=\"statements\">\n";
    for (const ReproducedStatement& s : item.statements)
        html += std::string("<li") + (s.holds ? "" : " class=\"fails\"") + ">" + escapedXml(sectionText(s.section)) +
                ": " + escapedXml(s.sentence) + " <b>" + (s.holds ? "Holds" : "Does not hold") +
                "</b>: " + escapedXml(s.figures) + "</li>\n";
    return html + "</ul>\n";
}

std::string htmlCommands(const Reproduction& item) {
    if (item.commands.empty()) return "";
    std::string html = "<details><summary>" + counted(item.commands.size(), "command") + ", " + timeText(item.seconds) +
                       "</summary>\n<pre><code>";
    for (const ReproducedCommand& c : item.commands) html += escapedXml(c.line) + "   # " + timeText(c.seconds) + "\n";
    return html + "</code></pre></details>\n";
}

std::string htmlItem(const Reproduction& item) {
    std::string html = "<section id=\"" + escapedXml(item.id) + "\">\n" +
                       element("h2", headingOf(item) + ": " + item.title) + "\n<p>" +
                       (item.thesis.empty() ? "" : "The thesis shows " + escapedXml(item.thesis)) + "</p>\n";
    if (!item.data.empty()) html += "<p class=\"faint\">Data: " + escapedXml(joined(item.data, "; ")) + "</p>\n";
    if (!item.error.empty()) html += "<p class=\"error\">It failed: " + escapedXml(item.error) + "</p>\n";
    html += htmlPictures(item);
    if (!item.numbers.empty()) html += htmlTable(numbersOf(item, true));
    for (const ReproducedTable& table : item.tables) html += htmlTable(table);
    html += htmlStatements(item);
    for (const std::string& remark : item.remarks) html += element("p", remark) + "\n";
    return html + htmlCommands(item) + "</section>\n";
}

std::string htmlContents(const ReproductionPage& page) {
    std::string html = "<h2>Contents</h2>\n<div class=\"wide contents\"><table>" +
                       htmlRow({"", "", "pictures", "statements that hold", "time"}, "th");
    for (const Reproduction& item : page.items)
        html += "<tr><td><a href=\"#" + escapedXml(item.id) + "\">" + escapedXml(headingOf(item)) +
                "</a></td><td style=\"text-align:left\">" + escapedXml(item.title) + "</td>" +
                element("td", std::to_string(item.pictures.size())) + element("td", verdictOf(item)) +
                element("td", timeText(item.seconds)) + "</tr>\n";
    return html + "</table></div>\n";
}

struct EquationUse {
    ReproducedEquation equation;
    std::vector<const Reproduction*> items;
};

/// "3.10" → {3, 10}; letters come last.
std::pair<double, double> orderOf(const std::string& number) {
    const std::size_t dot = number.find('.');
    double chapter = 0, rest = 0;
    if (!parseNumber(number.substr(0, dot), chapter)) return {1e9, 0};
    if (dot != std::string::npos) parseNumber(number.substr(dot + 1), rest);
    return {chapter, rest};
}

/// Each equation and file once, by number.
std::vector<EquationUse> equationsOf(std::span<const Reproduction> items) {
    std::vector<EquationUse> uses;
    for (const Reproduction& item : items)
        for (const ReproducedEquation& e : item.equations) {
            auto use = std::ranges::find(uses, e, &EquationUse::equation);
            if (use == uses.end()) use = uses.insert(uses.end(), {e, {}});
            use->items.push_back(&item);
        }
    std::ranges::stable_sort(uses, {}, [](const EquationUse& use) { return orderOf(use.equation.number); });
    return uses;
}

std::string htmlEquations(const ReproductionPage& page) {
    const std::vector<EquationUse> uses = equationsOf(page.items);
    if (uses.empty()) return "";
    std::string html =
        "<h2>Equations</h2>\n<div class=\"wide\"><table class=\"settings\">" + htmlRow({"", "file", "items"}, "th");
    for (const EquationUse& use : uses) {
        html += "<tr>" + element("td", "(" + use.equation.number + ")") + "<td><code>" + escapedXml(use.equation.file) +
                "</code></td><td>";
        for (std::size_t i = 0; i < use.items.size(); ++i)
            html += (i == 0 ? "" : ", ") + std::string("<a href=\"#") + escapedXml(use.items[i]->id) + "\">" +
                    escapedXml(use.items[i]->id) + "</a>";
        html += "</td></tr>\n";
    }
    return html + "</table></div>\n";
}

std::string summaryOf(const ReproductionPage& page) {
    std::size_t statements = 0, hold = 0, failed = 0, pictures = 0;
    double seconds = 0;
    for (const Reproduction& item : page.items) {
        statements += item.statements.size();
        hold += item.holding();
        failed += item.error.empty() ? 0 : 1;
        pictures += item.pictures.size();
        seconds += item.seconds;
    }
    return counted(page.items.size(), "item") + " with " + counted(pictures, "picture") + "; " + std::to_string(hold) +
           " of " + counted(statements, "statement") + " of its text hold" +
           (failed > 0 ? "; " + counted(failed, "item") + " failed" : "") + ". This call took " +
           timeText(page.seconds) + "; the items by themselves " + timeText(seconds) + " in sum.";
}

// --- Markdown ---

/// Text that Markdown shall show as it is.
std::string escapedMarkdown(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (std::string("\\`*_<>[]|").find(c) != std::string::npos) escaped += '\\';
        escaped += c == '\n' ? ' ' : c;
    }
    return escaped;
}

/// Broken between words into lines of at most `most` bytes.
std::string wrapped(const std::string& text, const std::string& indent = "", std::size_t most = 120) {
    std::string lines, line;
    for (const std::string& word : splitWords(text)) {
        if (!line.empty() && line.size() + 1 + word.size() > most) {
            lines += line + "\n";
            line = indent;
            line += word;
            continue;
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return lines + line + "\n";
}

std::string markdownRow(const std::vector<std::string>& cells) {
    std::string row = "|";
    for (const std::string& cell : cells) row += " " + escapedMarkdown(cell) + " |";
    return row + "\n";
}

std::string markdownTable(const ReproducedTable& table) {
    std::string text = table.caption.empty() ? "" : wrapped(escapedMarkdown(table.caption) + ":") + "\n";
    text += markdownRow(table.head) + "|";
    for (std::size_t c = 0; c < table.head.size(); ++c) text += "---|";
    text += "\n";
    for (const auto& row : table.rows) text += markdownRow(row);
    return text + "\n";
}

/// The anchor that Markdown makes of a heading: letters, digits, hyphens for blanks.
std::string anchorOf(const std::string& heading) {
    std::string anchor;
    for (const char c : lowerCase(heading))
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_')
            anchor += c;
        else if (c == ' ')
            anchor += '-';
        else if ((static_cast<unsigned char>(c) & 0x80) != 0)
            anchor += c;
    return anchor;
}

std::string markdownItem(const Reproduction& item) {
    std::string text =
        "## " + headingOf(item) + "\n\n" +
        wrapped("**" + escapedMarkdown(item.title) + ".** " + "The thesis shows " + escapedMarkdown(item.thesis)) +
        "\n";
    if (!item.data.empty()) text += wrapped("Data: " + escapedMarkdown(joined(item.data, "; ")) + ".") + "\n";
    if (!item.error.empty()) text += wrapped("It failed: " + escapedMarkdown(item.error)) + "\n";
    for (const ReproducedCommand& c : item.commands) text += "    " + c.line + "\n";
    text += "\n";
    const ReproducedTable numbers = numbersOf(item, false);
    if (!numbers.rows.empty()) text += markdownTable(numbers);
    for (const ReproducedTable& table : item.tables) text += markdownTable(table);
    for (const ReproducedStatement& s : item.statements)
        text += wrapped("- " + sectionText(s.section) + ": " + escapedMarkdown(s.sentence) + " **" +
                            (s.holds ? "Holds" : "Does not hold") + "**: " + escapedMarkdown(s.figures) + ".",
                        "  ");
    if (!item.statements.empty()) text += "\n";
    for (const std::string& remark : item.remarks) text += wrapped(escapedMarkdown(remark)) + "\n";
    return text;
}

std::string markdownEquations(std::span<const Reproduction> items) {
    std::string text = "| equation | file | command | result |\n|---|---|---|---|\n";
    for (const EquationUse& use : equationsOf(items)) {
        std::vector<std::string> ids, results;
        for (const Reproduction* item : use.items) {
            ids.push_back(item->id);
            results.push_back("[" + headingOf(*item) + "](#" + anchorOf(headingOf(*item)) + ")");
        }
        text += "| (" + use.equation.number + ") | `" + use.equation.file + "` | `reproduce " + joined(ids, " ") +
                "` | " + joined(results) + " |\n";
    }
    return text;
}

} // namespace

std::string htmlOf(const ReproductionPage& page) {
    const std::string title = "The figures and tables of the thesis";
    std::string html = element("h1", title) + "\n<p class=\"said\">" + escapedXml(summaryOf(page)) + "</p>\n" +
                       htmlContents(page) + htmlEquations(page);
    for (const Reproduction& item : page.items) html += htmlItem(item);
    html += "<section>\n<h2>To repeat it</h2>\n<pre><code>" + escapedXml(page.command) +
            "</code></pre>\n<p>The commands of the items run in the folder of this page.</p>\n<p class=\"faint\">" +
            escapedXml(page.program) + "</p>\n</section>\n";
    return htmlPage(title, kStyle, html);
}

std::string indexOf(std::span<const Reproduction> items) {
    std::string text =
        "# Figures and tables of the thesis, by one command\n\n"
        "    pellucid-cli reproduce --out DIR --data FOLDER\n\n"
        "reproduces them and writes DIR/index.html: the pictures, Pellucid's numbers beside those of the thesis, and "
        "whether the\nstatements of its text hold. `reproduce 3.4 4.5 --out DIR` reproduces only some of them, and "
        "`reproduce --list` lists all.\nFOLDER contains the real volumes. If one is missing, a sample replaces it, and "
        "the item says so.\n\n"
        "`pellucid-cli reproduce --out DIR --data FOLDER --index docs/reproduce.md` writes this page. Pellucid's own "
        "definitions\ncannot match the printed numbers of the thesis digit by digit, because its slices, colours and "
        "transfer functions differ\n([decisions/0004](decisions/0004-extinction-not-slices.md)). The published profile "
        "can, where the data of the thesis exist.\n\n## Equations\n\n" +
        markdownEquations(items) + "\n";
    for (const Reproduction& item : items) text += markdownItem(item);
    while (text.ends_with("\n\n")) text.pop_back();
    return text;
}

} // namespace pellucid
