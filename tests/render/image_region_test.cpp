#include <catch2/catch.hpp>

#include "render/image_region.h"

using pellucid::ImageRegion;

TEST_CASE("a region holds what lies within its outline, by the even-odd rule", "[region]") {
    const ImageRegion rectangle{{{0.25, 0.5}, {0.75, 0.5}, {0.75, 0.9}, {0.25, 0.9}}};
    CHECK(rectangle.contains(0.5, 0.7));
    CHECK_FALSE(rectangle.contains(0.2, 0.7));
    CHECK_FALSE(rectangle.contains(0.8, 0.7));
    CHECK_FALSE(rectangle.contains(0.5, 0.4));
    CHECK_FALSE(rectangle.contains(0.5, 0.95));
    // A lasso that crosses itself, drawn twice around its middle: what is surrounded twice is outside.
    const ImageRegion star{{{0.5, 0.0}, {0.8, 0.9}, {0.0, 0.35}, {1.0, 0.35}, {0.2, 0.9}}};
    CHECK_FALSE(star.contains(0.5, 0.5));
    CHECK(star.contains(0.5, 0.2));
    CHECK(star.contains(0.15, 0.4));
    CHECK_FALSE(star.contains(0.1, 0.1));
    // The direction in which it was drawn says nothing; a dent is outside.
    const ImageRegion dented{{{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0.5, 0.8}}};
    CHECK(dented.contains(0.5, 0.9));
    CHECK_FALSE(dented.contains(0.5, 0.5));
    CHECK(dented.contains(0.1, 0.5));
}

TEST_CASE("fewer than three corners hold nothing", "[region]") {
    CHECK_FALSE(ImageRegion{}.contains(0.5, 0.5));
    CHECK_FALSE((ImageRegion{{{0.5, 0.5}}}.contains(0.5, 0.5)));
    CHECK_FALSE((ImageRegion{{{0, 0}, {1, 1}}}.contains(0.5, 0.5)));
}
