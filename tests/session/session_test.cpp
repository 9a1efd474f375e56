#include <catch2/catch.hpp>

#include "session/session.h"

using namespace pellucid;

TEST_CASE("an empty session has no transfer function", "[session]") { CHECK(Session{}.tf() == nullptr); }
