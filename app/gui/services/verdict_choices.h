// What can be done about targets that are out of reach, each a button away.
#pragma once

#include <functional>
#include <vector>

#include "optimize/answer/verdict.h"
#include "services/notices.h"

namespace pellucid::gui {

class Services;

/// Of what a verdict found to help: take what is in reach as the targets, and the best changes that come nearer. All of
/// them are steps that undo takes back, but the view, which has a history of its own. `again`: looks for the targets
/// anew after such a change.
std::vector<Notice::Choice> choicesOf(Services& services, const Verdict& verdict, const std::function<void()>& again);

} // namespace pellucid::gui
