// What people do to the list of variables and to the channels that they drive.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/session.h"
#include "tf/formats/tf_parts.h"
#include "volume/grid_axes.h"

namespace pellucid {

/// What a variable can drive (thesis eq. 6.1). Opacity is driven by the first variable of the session.
enum class Channel { Opacity, Saturation, Brightness, Hue };

/// Throws UsageError where there is no variable `name`, nor what it is written to be made of.
void requireVariable(const Session& session, std::string name);

/// A name that no variable has yet: `wish`, else with a number behind it. Colons, which derivations are written with,
/// become blanks.
std::string freeVariableName(const Session& session, const std::string& wish);
/// After the file or sample, without its suffix and the number of its frame.
std::string nameOfSource(const VolumeSource& source);

/// Variables of the session that are made of `name`, directly or not.
std::vector<std::string> madeOf(const Session& session, const std::string& name);

/// At the end, under a free name, which it returns.
std::string addVariable(Session& session, Variable variable);
/// Channels and derived variables know it by the new name. Throws UsageError where that is empty, has a colon, or is
/// that of another one.
void renameVariable(Session& session, const std::string& from, const std::string& to);
/// Channels that it drives, or something made of it, are constant then. Throws UsageError where it is the only one, or
/// variables are made of it.
void removeVariable(Session& session, const std::string& name);

/// What drives the channel: a variable, plain or derived ("volatility:x:10"); empty: nothing.
std::string channelOf(const Session& session, Channel channel);
/// Of opacity: the variable and the first one change places in the list and in all channels, so that volatility is that
/// of the variable that is drawn; doing it again undoes it. One that is derived there becomes a variable of the
/// session.
void setChannel(Session& session, Channel channel, const std::string& name);
/// The same with the variable that drives brightness (thesis fig. 6.5); nothing without one.
void swapOpacityAndBrightness(Session& session);

/// What the values of a derived variable are by the definitions of the session's profile, in words.
std::string definitionOf(const Session& session, const Derivation& derivation);

/// The first variable, whose features, curve and opacity are those of the session: one of its variables, or what is
/// written like a derived one, which becomes one unless it is there already. Each keeps its transfer functions;
/// channels stay with what they name. Throws UsageError where there is no variable of this name, or of that it is made
/// of.
void setFeaturesOf(Session& session, const std::string& name);
/// What people may write for it: "gradient", "volatility:10" and "difference:0" are of the session's dataVariable(),
/// where no variable is called so.
std::string featuresOf(const Session& session, const std::string& text);

/// The variable that the first one comes from: itself, or what it is made of in the end. Its source is what is opened;
/// the session has variables.
const Variable& dataVariable(const Session& session);
void setDataSource(Session& session, const VolumeSource& source);
/// How the axes of the data of all variables run, and how far their voxels are apart; empty: as their files say.
void setDataAxes(Session& session, const std::optional<GridAxes>& axes);
void setDataSpacing(Session& session, const std::optional<GridSpacing>& spacing);
/// Both, of which the present data are `volume`: measures and clipping planes go along with them, and so do keyframes
/// and the state that is compared with. Throws UsageError as withSpacing() does.
void placeData(Session& session, const Volume& volume, const std::optional<GridAxes>& axes,
               const std::optional<GridSpacing>& spacing);
/// The camera that stands to a grid as `camera` did before its voxels were as far apart as they are in `after`.
Camera cameraOfSpaced(const Camera& camera, const Geometry& before, const Geometry& after);

/// Colours, opacities or range of another transfer function in the place of those of the session; a range becomes the
/// window of the variable. `window`: the present one, for a transfer function that says of no values; nothing happens
/// where neither has a range.
void takeTfParts(Session& session, const TransferFunction& other, const TfParts& parts, const ValueRange& window);

/// Latest frames of the volatility that the features are of; empty where they are of something else.
std::optional<int> featureFrames(const Session& session);
void setFeatureFrames(Session& session, int frames);

/// Latest frames of the volatility that drives a channel; empty where none does.
std::optional<int> volatilityFrames(const Session& session);
void setVolatilityFrames(Session& session, int frames);

/// Where no channel but opacity is driven: volatility of the first variable drives saturation where `varies`, the
/// second variable brightness.
void startMapping(Session& session, bool varies);

} // namespace pellucid
