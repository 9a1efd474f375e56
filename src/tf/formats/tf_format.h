// What each file format of transfer functions does, and the table of them. A format is one file; to add one, write its
// `…Format()`, declare it here and name it in tf_formats.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tf/formats/opacity_length.h"
#include "tf/transfer_function.h"

namespace pellucid {

class ForeignFile;

/// A transfer function as a file has it.
struct ReadTf {
    TransferFunction tf;  ///< its range where the file is in data units, else none
    OpacityLength length; ///< of the path that its opacities hold for
    /// Opened as it is, whatever its length: the thesis takes Voreen's opacities for those of one voxel.
    bool opensAsItIs = false;
    bool hasColors = true, hasOpacities = true; ///< false: the file says nothing of them, and something was put there
    /// Where the file is not in data units: what it calls the two ends of the range that it is put on, such as 0 and 1.
    std::optional<ValueRange> positions;
    bool spansData = false; ///< with `positions`: that range is the one of the data, whatever the window is
    /// What the file has and a transfer function here has not, and what was assumed: each a sentence without a full
    /// stop.
    std::vector<std::string> notices;
};

/// What a writer is given.
class TfToWrite {
public:
    /// `window`: the data units of x where `tf` has no range; empty: none are known. `volume`: how the volume lies that
    /// it was made for; empty: unknownVolume() is taken. `data`: its smallest and largest value, where they are known.
    TfToWrite(const TransferFunction& tf, const std::optional<ValueRange>& window,
              const std::optional<Geometry>& volume, std::string name, const std::optional<ValueRange>& data = {});

    const TransferFunction& tf() const { return m_tf; } ///< as it is; points() are without what an eye hides
    const std::string& name() const { return m_name; }  ///< of a preset
    const ValueRange& range() const { return m_range; } ///< data units of x = 0 and 1
    bool hasRange() const { return m_hasRange; }
    const Geometry& geometry() const { return m_geometry; }
    bool hasVolume() const { return m_hasVolume; }
    double value(double x) const { return m_range.lo + x * (m_range.hi - m_range.lo); }
    const std::optional<ValueRange>& dataRange() const { return m_data; } ///< two values at least

    /// The smallest and largest value are those of this alone, "frame 3"; empty: of all data.
    void sayDataIsOf(const std::string& part) { m_dataOf = part; }
    const std::string& dataOf() const { return m_dataOf; }

    /// The same over the range of the data, for programs that lay 0 to 1 over it; as it is where either range is not
    /// known. Without features.
    TfToWrite overData() const;
    /// All points from x = 0 to x = 1 with opacities of a path of `length`.
    std::vector<ControlPoint> points(const OpacityLength& length) const;
    /// The same, no two of them at one x: those of a step lie 1e-6 of the range apart.
    std::vector<ControlPoint> pointsApart(const OpacityLength& length) const;
    /// What readers of this format have kept of a file (TransferFunction::extraJson), as one JSON object in text.
    std::string keptOf(const char* format) const;

private:
    TransferFunction m_tf;
    std::string m_name;
    ValueRange m_range;
    Geometry m_geometry;
    bool m_hasRange = false, m_hasVolume = false;
    std::optional<ValueRange> m_data;
    std::string m_dataOf;
};

struct WrittenTf {
    std::string text;
    std::vector<std::string> losses; ///< each a sentence without a full stop
};

struct TfFormat {
    const char* name;                        ///< as one types it: "slicer-vp"
    const char* title;                       ///< in a list: "3D Slicer, older volume property"
    const char* inWords;                     ///< a file of it, in a sentence: "an older volume property of 3D Slicer"
    const char* suffix;                      ///< ".vp"
    bool ownSuffix;                          ///< nothing else has it: such a file is of this format, whatever is in it
    const char* loses;                       ///< what it cannot say, in a few words; for people
    bool (*knows)(const ForeignFile& file);  ///< by its content
    ReadTf (*read)(const ForeignFile& file); ///< throws Error
    WrittenTf (*write)(const TfToWrite& tf); ///< throws Error
    /// Names of all that are in a file, each another one (FILE#NAME); null: its files hold one.
    std::vector<std::string> (*names)(const ForeignFile& file) = nullptr;
};

TfFormat pellucidTfFormat();
TfFormat paraViewFormat();
TfFormat slicerFormat();
TfFormat slicerVpFormat();
TfFormat voreenFormat();
TfFormat slicerXmlFormat();
TfFormat paraViewXmlFormat();
TfFormat inviwoFormat();
TfFormat niivueFormat();
TfFormat vtkJsFormat();
TfFormat csvTfFormat();
TfFormat imageVis3DFormat();
TfFormat mitkFormat();
TfFormat itkSnapFormat();

/// All of them, in the order in which they are offered.
std::span<const TfFormat> tfFormats();
/// Throws UsageError that lists them.
const TfFormat& tfFormatNamed(const std::string& name);
/// By suffix where it belongs to one format, else by content. Throws FileError where none knows the file.
const TfFormat& tfFormatOf(const ForeignFile& file);

/// Writes for another program, and says what that loses: what all formats lose, and what this one does.
WrittenTf writtenTf(const TfFormat& format, const TfToWrite& tf);
/// What no other program has, and what was assumed.
std::vector<std::string> commonLosses(const TfToWrite& tf);

// ---- what several formats say in the same words

/// Puts `json`, an object in text, into extraJson under `key`; nothing where it is empty.
void keepAs(TransferFunction& tf, const char* key, const std::string& json);
/// "opacities and colours are rounded to 256 steps", and how many opacities vanish by it.
void addEightBitLosses(std::vector<std::string>& losses, const std::vector<ControlPoint>& points);
/// Points that VTK takes for transparent.
void addVtkLosses(std::vector<std::string>& losses, const std::vector<ControlPoint>& points);
/// That no domain is stored, and which values the program is taken to lay the curve over.
void addNoDomainLoss(std::vector<std::string>& losses, const TfToWrite& tf, const char* program);
/// That no domain is in a file with these positions, and which values it is put on; empty: none are known.
std::string noDomainNotice(const ValueRange& positions, const std::optional<ValueRange>& values);
/// 0 … 255
int eightBits(double value);

} // namespace pellucid
