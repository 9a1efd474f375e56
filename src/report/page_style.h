// How our HTML pages look: light, dark, and on paper.
#pragma once

#include <string>

namespace pellucid {

/// The rules of a `<style>` element.
std::string pageStyle();

/// A whole page. `title` is escaped here; `style` is added to pageStyle(), `body` stands as it is.
std::string htmlPage(const std::string& title, const std::string& style, const std::string& body);

} // namespace pellucid
