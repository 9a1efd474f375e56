#include "widgets/preferences.h"

#include <QSettings>

#include "base/memory.h"
#include "base/parallel.h"

namespace pellucid {

template <>
std::span<const Setting> settingsOf<gui::Preferences>() {
    using gui::Preferences;
    static constexpr const char* kThemes[] = {"Dark", "Light", "As the system"};
    static constexpr const char* kSchemes[] = {"Pellucid", "ParaView", "3D Slicer"};
    static const Setting kSettings[] = {
        {.key = "theme",
         .at = member<&Preferences::theme>,
         .words = "&Theme",
         .help = "Colours of the window. Those of the picture are the display's and the data's.",
         .choices = kThemes},
        {.key = "mouse",
         .at = member<&Preferences::mouse>,
         .words = "&Mouse as in",
         .help = "Whose habits the mouse follows over the volume. Slices keep their own.",
         .choices = kSchemes},
        {.key = "memoryGiB",
         .at = member<&Preferences::memoryGiB>,
         .words = "M&emory",
         .help = "How much memory the program may take. What needs more is opened coarser or refused before it starts; "
                 "pellucid-cli takes the same as --memory.",
         .range = {0, 1e6, NumberRange::Open::Low},
         .unit = "GiB"},
        {.key = "threads",
         .at = member<&Preferences::threads>,
         .words = "Th&reads",
         .help = "How many threads draw and measure; 0 takes all cores. Figures are the same with any number; "
                 "pellucid-cli takes the same as --threads.",
         .range = {0, 1024}},
        {.key = "recentCount",
         .at = member<&Preferences::recentCount>,
         .words = "&Files in the list",
         .help = "How many files File, Open recent keeps; 0 keeps none.",
         .range = {0, 30}},
        {.key = "recentPictures",
         .at = member<&Preferences::recentPictures>,
         .words = "Keep &pictures of recent files",
         .help =
             "A small picture of each file as it was left, in your cache folder. It shows data: switch it off where "
             "these must not lie on the disk, and those that are there are removed."},
        {.key = "recentAtStart",
         .at = member<&Preferences::recentAtStart>,
         .words = "Offer recent files at the &start",
         .help = "Beside the sample, where the program starts without a file."},
    };
    return kSettings;
}

namespace gui {

Preferences keptPreferences() {
    Preferences kept;
    const QSettings settings;
    for (const Setting& setting : settingsOf<Preferences>()) {
        const QVariant text = settings.value(setting.key);
        if (!text.isValid()) continue;
        const Preferences before = kept;
        try {
            setText(setting, &kept, text.toString().toStdString());
            check(setting, &kept);
        } catch (const Error&) { // the file may have been edited, or be of another version
            kept = before;
        }
    }
    return kept;
}

void keepPreferences(const Preferences& preferences) {
    static const Preferences kUsual;
    QSettings settings;
    for (const Setting& setting : settingsOf<Preferences>()) {
        const std::string text = textOf(setting, &preferences);
        if (text == textOf(setting, &kUsual))
            settings.remove(setting.key);
        else
            settings.setValue(setting.key, QString::fromStdString(text));
    }
}

void applyPreferences(const Preferences& preferences) {
    constexpr double kGiB = 1u << 30;
    setThreadCount(preferences.threads);
    setMemoryLimit(preferences.memoryGiB ? std::optional(static_cast<std::uint64_t>(*preferences.memoryGiB * kGiB))
                                         : std::nullopt);
    setMouseScheme(preferences.mouse);
}

} // namespace gui
} // namespace pellucid
