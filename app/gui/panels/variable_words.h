// Variables in words, and the titles of docks that say whose transfer function they show.
#pragma once

#include <QString>

#include "session/session.h"

class QWidget;

namespace pellucid::gui {

class Services;

/// A variable of the session in words: "volatility of x, 10 frames", "p*.mhd".
QString originText(const Variable& variable);
/// What a channel may name, in words: "x", "gradient of x".
QString driverText(const Session& session, const std::string& name);

/// What features may be of, in words: "x", "volatility of x, 10 frames", "motion (volatility of x, 10 frames)".
QString featuresText(const Session& session, const std::string& name);

/// In words, whose opacity the curve says and where colours come from: title of the editor of transfer functions.
QString curveTitle(const Session& session);
/// In words, whose features those of the list are.
QString featuresTitle(const Session& session);
/// Keeps the title of a dock so; a title takes no room from the picture, whatever it says.
void followTitle(Services& services, QWidget* dock, QString (*title)(const Session&));

} // namespace pellucid::gui
