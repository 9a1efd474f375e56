// Which of several transfer functions in a file is meant.
#pragma once

#include <QString>

class QWidget;

namespace pellucid::gui {

/// "FILE#NAME" of the one that the user chooses from a list, in the dialog "presetDialog"; empty: the user gave up.
/// `path` itself where it holds one, or cannot be read: opening it says why.
QString askPreset(const QString& path, QWidget* parent);

/// What people call it: without the folder.
QString nameOfPreset(const QString& path);

} // namespace pellucid::gui
