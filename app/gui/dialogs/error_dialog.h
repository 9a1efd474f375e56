// The dialog that says what went wrong, where, and what to do about it.
#pragma once

#include <QString>

#include "base/error.h"

class QWidget;

namespace pellucid::gui {

/// What to do about an error, in the words of the window's own controls.
QString adviceFor(const Error& error);

/// Does not wait for an answer. The parts are labels named errorWhat, errorWhere and errorWhatToDo.
void showError(QWidget* parent, const QString& title, const Error& error);
/// Waits until it has been read: of a dialog that comes back then.
void showErrorFirst(QWidget* parent, const QString& title, const Error& error);

} // namespace pellucid::gui
