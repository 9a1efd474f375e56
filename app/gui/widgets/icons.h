// Icons of the tool bar: drawings of our own in the colour of the window's text, sharp at every size and scale.
#pragma once

#include <vector>

#include <QIcon>
#include <QString>

namespace pellucid::gui {

struct IconFile {
    const char *name, *svg; ///< "openAction.svg"; with currentColor where the text's colour goes
};
/// All that data/icons has.
const std::vector<IconFile>& iconFiles();

/// The icon that is called as an action is; null where there is none. It follows the theme.
QIcon iconNamed(const QString& action);

} // namespace pellucid::gui
