// Where an item works: it runs commands in the folder of the report, and puts down what they show.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "output.h"
#include "reproduce/item.h"
#include "tf/transfer_function.h"

namespace pellucid::cli {

using Words = std::vector<std::string>; ///< arguments
inline Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// What is the same for all items.
struct DeskSettings {
    std::filesystem::path program;             ///< pellucid-cli, absolute
    std::filesystem::path folder;              ///< of the report, absolute; commands run there
    std::optional<std::filesystem::path> data; ///< --data, absolute
    int sampleSize = 64;                       ///< voxels along the longest axis of samples
    /// Options of every command that does not give them itself, with their values: --threads, --memory.
    std::vector<std::pair<std::string, std::string>> common = {};
};

/// Links in the folder of the report to --data and to the folder `thesis` beside it, so that commands name files
/// shortly.
inline constexpr const char *kDataLink = "data", *kThesisLink = "thesis";

/// Data as commands name them.
struct Source {
    Words words;      ///< "data/tooth/tooth.mhd", or "sample:knee --sample-size 64"
    std::string said; ///< "tooth/tooth.mhd, the tooth (140×120×161) of the thesis"
    bool isReal = false, isTheSame = false;
};

/// What stands for `need`: the file below --data where it is there, else the sample.
Source sourceOf(const DataNeed& need, const DeskSettings& settings);
/// The file below --data; empty where it is not there.
std::optional<std::filesystem::path> realFileOf(const DataNeed& need, const DeskSettings& settings);

/// A feature in the answer of `measure`.
struct FeatureFigures {
    std::string name;
    double opacity = 0, visibility = 0, vws = 0, brightness = 0, saturation = 0, cover = 0;
    double fs = 0; ///< 0 without --2dfs
};
std::vector<FeatureFigures> featuresOf(const Json& measured);

class Desk {
public:
    /// Makes the item's folder. Throws FileError.
    Desk(const Item& item, const DeskSettings& settings, std::stop_token stop);

    const DeskSettings& settings() const { return m_settings; }
    /// The item's data, by the place in Item::data; the report says that they were used.
    Source data(std::size_t need = 0);
    /// A sample in place of what the thesis used, where there is a reason not to take data(); of `size` voxels.
    Source sample(const std::string& name, int size, const std::string& inPlaceOf);

    /// A file of the item as commands name it, from the folder of the report: "3.4/after.tf.json".
    std::string file(const std::string& name) const { return m_result.id + "/" + name; }
    std::filesystem::path pathOf(const std::string& file) const { return m_settings.folder / file; }
    /// Writes a transfer function of data/tf into the item's folder: "disks" → "4.1/disks.tf.json".
    std::string tf(const std::string& name);
    std::string writeTf(const std::string& name, const TransferFunction& tf);
    TransferFunction readTf(const std::string& file) const;

    /// `pellucid-cli WORD…`, recorded with its time. Throws Error with what it said where it fails.
    void run(const Words& words);
    /// The same with --json: its answer, which stays in the item's folder as NAME.json.
    Json ask(const std::string& name, const Words& words);
    /// `render WORD… --size … --out NAME`, which becomes a picture of the report.
    void render(const std::string& name, const std::string& figure, const std::string& caption, const Words& words);
    /// Width and height of pictures.
    static constexpr const char* kPictureSize = "384x384";

    /// What the report shows. `file` as file() gives it.
    void picture(const std::string& file, const std::string& figure, const std::string& caption);
    void number(const std::string& what, double ours, double thesis, const std::string& unit = "");
    void table(ReproducedTable table) { m_result.tables.push_back(std::move(table)); }
    /// A sentence of section `section`, whether it holds, and the figures that say so; `otherwise` becomes a remark
    /// where it does not.
    void statement(const std::string& section, const std::string& sentence, bool holds, const std::string& figures,
                   const std::string& otherwise = "");
    /// On a difference from the thesis.
    void remark(const std::string& sentence) { m_result.remarks.push_back(sentence); }

    Reproduction result(double seconds) const;

private:
    Source used(Source source); ///< the report says so
    std::string start(const Words& words, const std::string& out);

    const DeskSettings& m_settings;
    std::stop_token m_stop;
    std::vector<DataNeed> m_needs;
    Reproduction m_result;
};

} // namespace pellucid::cli
