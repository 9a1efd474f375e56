// *.study.json: what people are asked to look at, and how (docs/method.md, "Studies"; thesis §4.5 and appendix B).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/color.h"
#include "base/setting.h"

namespace pellucid {

/// A picture and the feature that is asked about. Names of files are as this process would open them.
struct Stimulus {
    std::string id;              ///< isStudyId(), one of its own
    std::string session, volume; ///< a session, or a volume (a file or sample:NAME): one of the two
    std::string tf;              ///< in place of the session's, as loadTf() takes it, or kAutomaticTf; empty: none
    std::string view;            ///< in place of the session's camera, as viewFromText() takes it; empty: none
    std::string feature;         ///< its name in the transfer function
    std::string label;           ///< what the question calls it; empty: as its name
    bool training = false;       ///< shown first, to practise, and not analysed

    std::string picture;                       ///< file; empty: not prepared
    std::optional<double> vws, visibility, fs; ///< of the feature, measured in this picture; empty: not known
    std::string engine;                        ///< that measured; empty: none has
    std::string data;                          ///< what its volume is called; empty: not prepared
    std::optional<Rgb> color;                  ///< of the feature in the transfer function; empty: not prepared

    std::string extraJson; ///< unknown keys of the file it came from

    const std::string& word() const { return label.empty() ? feature : label; }
    bool operator==(const Stimulus&) const = default;
};

/// A study before anyone has taken part.
struct Study {
    std::string title = "Study";
    std::string consent =
        "You will be shown pictures of volume data and asked about each. Taking part is voluntary, and you may "
        "stop at any time. Your answers are kept without your name.";
    std::string instructions =
        "Each question names a part of the picture that follows it. Look at the picture until it goes, and "
        "then say how clear and distinct that part was.";
    std::string question = "How clear and distinct is the {feature} feature?"; ///< {feature}: Stimulus::word()
    std::map<int, std::string> labels{{1, "Not at all"}, {3, "Neutral"}, {5, "Very clear"}}; ///< of scores 1 to 5
    double taskSeconds = 3, imageSeconds = 17;
    int repeats = 0;     ///< how many stimuli are shown a second time, training left out
    int pauseEvery = 20; ///< trials between two pauses; 0: no pauses
    int seed = 1;        ///< of the order
    Rgb background{128.0 / 255, 128.0 / 255, 128.0 / 255}; ///< of the pictures and of the screen: #808080, as files say
    int width = 800, height = 600;                         ///< pixels of the pictures
    std::vector<Stimulus> stimuli;
    std::string extraJson;

    /// Null where none has this id.
    const Stimulus* find(const std::string& id) const;
    /// The question about a stimulus.
    std::string questionOf(const Stimulus& stimulus) const;
    /// How many stimuli are not for training.
    int countOfTrials() const;
    bool operator==(const Study&) const = default;
};
template <>
std::span<const Setting> settingsOf<Study>(); ///< beside labels, size and stimuli

inline constexpr int kLowestScore = 1, kHighestScore = 5;
inline constexpr int kSmallestPicture = 32; ///< pixels along a side that 2D feature saliency can tell something of

/// Whether a text can name a stimulus or a participant, and a file: 1 to 40 letters (a–z, A–Z), digits, "-" and "_",
/// the first of them a letter or digit.
bool isStudyId(const std::string& text);

/// An id that no stimulus of the study has: "s01", "s02", …
std::string freeStimulusId(const Study& study);

/// Throws Error with place and reason. Unknown keys are kept; the files that stimuli name need not be there.
Study readStudy(const std::string& path);
/// Files relative to that of the study. Throws FileError.
void writeStudy(const Study& study, const std::string& path);

/// The study, which can be written and read back. Throws Error with `where` where it cannot: a stimulus or number that
/// is not allowed.
Study checked(Study study, const std::string& where);

/// The study that was prepared into a folder. Throws Error where it is none, or has a stimulus without picture.
Study readPreparedStudy(const std::string& folder);
/// Where a folder has it, its pictures and what participants answer.
std::string preparedStudyFile(const std::string& folder);
std::string picturesFolder(const std::string& folder);
std::string participantsFolder(const std::string& folder);

} // namespace pellucid
