// The volumes of section 5.4 with their starts, and searches on them as the thesis's author made them: by the published
// profile.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "report/plot.h"
#include "reproduce/desk.h"

namespace pellucid::cli {

/// What table 5.1 prints of a search.
struct PrintedSearch {
    int steps;
    double seconds;
};

struct SearchCase {
    std::string name; ///< "nucleon"
    DataNeed data;
    int sampleSize;                       ///< voxels along the longest axis of what stands for it, at most
    std::string along, view;              ///< the side of the published profile, and the same view for pictures
    std::vector<double> peaks;            ///< of three tents
    std::array<Rgb, 3> colors;            ///< of these
    std::string thesisStart;              ///< the thesis's own start, a file in kThesisLink; empty: it is not at hand
    std::string targets;                  ///< as --target takes them
    std::array<PrintedSearch, 3> printed; ///< fixed step, line search, parallel line search
};
/// Nucleon, tooth, CT-Knee, vortex.
const std::vector<SearchCase>& searchCases();
std::vector<DataNeed> dataOf(const std::vector<SearchCase>& cases);

inline constexpr std::array<const char*, 3> kThesisMethods{"fixed", "line", "parallel"};

/// A search as `optimize` tells it.
struct Search {
    bool converged = false;
    int moves = 0, evaluations = 0;
    double seconds = 0; ///< of the search alone
    std::vector<double> objective;
    std::vector<std::vector<double>> vws, opacity; ///< per state, per feature
    double last() const { return objective.back(); }
};
Search searchOf(const Json& optimized);

/// A case while an item works on it.
class CaseAtDesk {
public:
    /// `need`: place of its data in those of the item. `peaks`, where they are given, take the place of those of the
    /// case, and `thesisStart` that of its file.
    CaseAtDesk(Desk& desk, const SearchCase& of, std::size_t need, std::vector<double> peaks = {},
               const std::string& thesisStart = {});

    const SearchCase& of() const { return m_case; }
    const std::string& start() const { return m_start; } ///< the file of its transfer function
    /// Data and start are those of the thesis.
    bool isTheThesiss() const { return m_isTheThesiss; }
    const Words& volume() const { return m_source.words; }
    /// Volume and profile, for commands that measure.
    Words measured() const;
    /// Volume and view, for those that draw.
    Words drawn() const;
    /// A search from the start, told in NAME.json.
    Search search(const std::string& name, const std::string& method, const Words& more = {});

private:
    Desk& m_desk;
    const SearchCase& m_case;
    Source m_source;
    std::string m_start;
    bool m_isTheThesiss = false;
};

/// Three tents of these peaks and colours.
TransferFunction threeTents(const std::vector<double>& peaks, const std::array<Rgb, 3>& colors);

/// F over the moves, a curve per search.
Plot objectivesPlot(const std::string& title, const std::vector<std::pair<std::string, Search>>& searches);
/// Draws it into the item's folder, as a picture of the report.
void drawPlot(Desk& desk, const std::string& name, const std::string& figure, const std::string& caption,
              const Plot& plot);

/// "0.1, 0.3, 0.6"
std::string figuresText(const std::vector<double>& values);

} // namespace pellucid::cli
