// A figure or table of the thesis, done again: pictures, our numbers beside its own, and whether what its text says
// holds. What pages, indices and JSON files of `reproduce` are made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace pellucid {

/// An equation of the thesis, and where the program has it.
struct ReproducedEquation {
    std::string number; ///< "3.3"; "A" for those of appendix A, which have no numbers
    std::string file;   ///< from the root of the sources
    bool operator==(const ReproducedEquation&) const = default;
};

struct ReproducedPicture {
    std::string file;   ///< from the folder of the page; PNG or SVG
    std::string figure; ///< of the thesis, "3.5 (b)"; may be empty
    std::string caption;
    bool operator==(const ReproducedPicture&) const = default;
};

/// A number that the thesis prints, and ours.
struct ReproducedNumber {
    std::string what;
    double ours = 0;
    double thesis = 0;
    std::string unit; ///< "s", "moves"; may be empty. Numbers in seconds differ from run to run
    bool operator==(const ReproducedNumber&) const = default;
};

/// Numbers of ours that the thesis shows as a drawing.
struct ReproducedTable {
    std::string caption;
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows; ///< each as long as the head
    bool operator==(const ReproducedTable&) const = default;
};

/// Something that the text of the thesis says and software can tell.
struct ReproducedStatement {
    std::string sentence; ///< what it says
    std::string section;  ///< where, "4.3.5"
    bool holds = false;   ///< computed
    std::string figures;  ///< what that rests on, in numbers
    bool operator==(const ReproducedStatement&) const = default;
};

struct ReproducedCommand {
    std::string line;   ///< as typed into a shell, in the folder of the page
    double seconds = 0; ///< that it took
    bool operator==(const ReproducedCommand&) const = default;
};

struct Reproduction {
    std::string id;                 ///< "3.4": what it is asked for by, and the name of its folder
    std::vector<std::string> shows; ///< every figure and table that it does again, as in "Figure 3.4", "Table 3.2"
    std::string title;
    std::string thesis;                        ///< goes on after "The thesis shows ", to a full stop
    std::vector<ReproducedEquation> equations; ///< that it exercises
    std::vector<std::string> data;             ///< which data, and in place of which
    std::vector<ReproducedPicture> pictures;
    std::vector<ReproducedNumber> numbers;
    std::vector<ReproducedTable> tables;
    std::vector<ReproducedStatement> statements;
    std::vector<std::string> remarks; ///< on differences
    std::vector<ReproducedCommand> commands;
    double seconds = 0; ///< in all
    std::string error;  ///< why it could not be done; empty: it was

    bool operator==(const Reproduction&) const = default;
    std::size_t holding() const; ///< how many of the statements hold
};

/// "3.4, 3.5" → "Figures 3.4 and 3.5"; "A.1, A.2, A.3" → "Figures A.1 to A.3"; "table-3.2" → "Table 3.2";
/// "section-5.4.2" → "Section 5.4.2".
std::string headingOf(const Reproduction& item);
/// The one command that does the item again.
std::string commandOf(const Reproduction& item);

/// Everything; read back it is equal.
nlohmann::ordered_json jsonFromReproduction(const Reproduction& item);
/// Throws Error with the place where the document is none of these; `where` is its name in messages.
Reproduction reproductionFromJson(const nlohmann::json& document, const std::string& where);

/// "0.5293", "4.0e-05": a figure of the pages.
std::string figureText(double value);
/// "0.5293 → 0.6": what becomes of a figure.
std::string fromTo(double before, double after);

} // namespace pellucid
