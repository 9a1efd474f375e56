#include "report/reproduction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/json_value.h"
#include "base/round_numbers.h"
#include "base/text.h"

namespace pellucid {

namespace {

using Json = nlohmann::ordered_json;

/// The members of a list, each read by `read`.
template <class Read>
auto listOf(const JsonValue& object, const char* key, const Read& read) {
    std::vector<decltype(read(object))> list;
    for (const JsonValue& one : object[key].items()) list.push_back(read(one));
    return list;
}
std::string readText(const JsonValue& value) { return value.text(); }
std::vector<std::string> textsOf(const JsonValue& object, const char* key) { return listOf(object, key, readText); }

ReproducedTable readTable(const JsonValue& t) {
    ReproducedTable table{t["caption"].text(), textsOf(t, "head"), {}};
    for (const JsonValue& row : t["rows"].items()) {
        table.rows.emplace_back();
        for (const JsonValue& cell : row.items(table.head.size())) table.rows.back().push_back(cell.text());
    }
    return table;
}

/// JSON has no NaN: it is written as null.
double figureAt(const JsonValue& object, const char* key) {
    const JsonValue value = object[key];
    return value.json().is_null() ? std::numeric_limits<double>::quiet_NaN() : value.number();
}

/// "4.7", "4.8", "4.9"
bool followEachOther(const std::vector<std::string>& numbers) {
    const auto split = [](const std::string& number) {
        const std::size_t dot = number.find('.') + 1;
        std::int64_t place = 0;
        return std::pair(number.substr(0, dot), parseNumber(number.substr(dot), place) ? place : -1);
    };
    for (std::size_t i = 1; i < numbers.size(); ++i) {
        const auto before = split(numbers[i - 1]), here = split(numbers[i]);
        if (before.first != here.first || before.second < 0 || here.second != before.second + 1) return false;
    }
    return true;
}

template <class T, class Write>
Json listFrom(const std::vector<T>& all, const Write& write) {
    Json list = Json::array();
    for (const T& one : all) list.push_back(write(one));
    return list;
}

} // namespace

std::size_t Reproduction::holding() const {
    return static_cast<std::size_t>(std::ranges::count_if(statements, &ReproducedStatement::holds));
}

std::string headingOf(const Reproduction& item) {
    std::string kind = "Figure", prefix;
    for (const auto& [begin, other] : {std::pair{"table-", "Table"}, {"section-", "Section"}})
        if (!item.shows.empty() && item.shows.front().starts_with(begin)) {
            kind = other;
            prefix = begin;
        }
    std::vector<std::string> numbers;
    for (const std::string& name : item.shows) numbers.push_back(name.substr(prefix.size()));
    if (numbers.size() == 1) return kind + " " + numbers.front();
    if (numbers.size() > 2 && followEachOther(numbers)) return kind + "s " + numbers.front() + " to " + numbers.back();
    const std::string last = numbers.back();
    numbers.pop_back();
    return kind + "s " + joined(numbers) + " and " + last;
}

std::string commandOf(const Reproduction& item) { return "pellucid-cli reproduce " + item.id + " --out DIR"; }

Json jsonFromReproduction(const Reproduction& item) {
    return {{"id", item.id},
            {"shows", item.shows},
            {"title", item.title},
            {"thesis", item.thesis},
            {"equations", listFrom(item.equations,
                                   [](const ReproducedEquation& e) {
                                       return Json{{"number", e.number}, {"file", e.file}};
                                   })},
            {"data", item.data},
            {"pictures", listFrom(item.pictures,
                                  [](const ReproducedPicture& p) {
                                      return Json{{"file", p.file}, {"figure", p.figure}, {"caption", p.caption}};
                                  })},
            {"numbers",
             listFrom(item.numbers,
                      [](const ReproducedNumber& n) {
                          return Json{{"what", n.what}, {"ours", n.ours}, {"thesis", n.thesis}, {"unit", n.unit}};
                      })},
            {"tables", listFrom(item.tables,
                                [](const ReproducedTable& t) {
                                    return Json{{"caption", t.caption}, {"head", t.head}, {"rows", t.rows}};
                                })},
            {"statements", listFrom(item.statements,
                                    [](const ReproducedStatement& s) {
                                        return Json{{"sentence", s.sentence},
                                                    {"section", s.section},
                                                    {"holds", s.holds},
                                                    {"figures", s.figures}};
                                    })},
            {"remarks", item.remarks},
            {"commands", listFrom(item.commands,
                                  [](const ReproducedCommand& c) {
                                      return Json{{"line", c.line}, {"seconds", c.seconds}};
                                  })},
            {"seconds", item.seconds},
            {"error", item.error}};
}

Reproduction reproductionFromJson(const nlohmann::json& document, const std::string& where) {
    const JsonValue json(document, where);
    Reproduction item;
    item.id = json["id"].text();
    item.shows = textsOf(json, "shows");
    item.title = json["title"].text();
    item.thesis = json["thesis"].text();
    item.equations = listOf(json, "equations", [](const JsonValue& e) {
        return ReproducedEquation{e["number"].text(), e["file"].text()};
    });
    item.data = textsOf(json, "data");
    item.pictures = listOf(json, "pictures", [](const JsonValue& p) {
        return ReproducedPicture{p["file"].text(), p["figure"].text(), p["caption"].text()};
    });
    item.numbers = listOf(json, "numbers", [](const JsonValue& n) {
        return ReproducedNumber{n["what"].text(), figureAt(n, "ours"), figureAt(n, "thesis"), n["unit"].text()};
    });
    item.tables = listOf(json, "tables", readTable);
    item.statements = listOf(json, "statements", [](const JsonValue& s) {
        return ReproducedStatement{s["sentence"].text(), s["section"].text(), s["holds"].boolean(),
                                   s["figures"].text()};
    });
    item.remarks = textsOf(json, "remarks");
    item.commands = listOf(json, "commands", [](const JsonValue& c) {
        return ReproducedCommand{c["line"].text(), c["seconds"].number()};
    });
    item.seconds = json["seconds"].number();
    item.error = json["error"].text();
    return item;
}

std::string figureText(double value) {
    const double size = std::abs(value);
    if (size != 0 && size < 0.001) return shortText(value);
    return size < 10 ? fixedText(value, 4) : shortText(value);
}

std::string fromTo(double before, double after) { return figureText(before) + " → " + figureText(after); }

} // namespace pellucid
