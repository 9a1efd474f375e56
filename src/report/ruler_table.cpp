#include "report/ruler_table.h"

#include "base/csv.h"

namespace pellucid {

std::string csvOf(const std::vector<Ruler>& rulers, const RulerReadings& readings, const Geometry& geometry,
                  PatientAxes axes) {
    CsvTable table;
    for (const char* column :
         {"name", "kind", "length", "angle", "radius", "mean", "sigma", "min", "max", "voxels", "invalid",    "outside",
          "unit", "x1",   "y1",     "z1",    "x2",     "y2",   "z2",    "x3",  "y3",  "z3",     "coordinates"})
        table << column;
    table.endLine();
    const std::string coordinates = coordinatesText(axes, geometry);
    for (const Ruler& ruler : rulers) {
        const auto known = readings.find(ruler.number);
        const RulerReading reading = known != readings.end() ? known->second : readGeometry(ruler);
        table << ruler.name << name(ruler.kind) << reading.length << reading.angle;
        table << (ruler.kind == RulerKind::Sphere ? std::optional(ruler.radius) : std::nullopt);
        const auto number = [&](auto member, bool needsVoxels) {
            const bool has = reading.values && (!needsVoxels || reading.values->count > 0);
            table << (has ? std::optional(static_cast<double>((*reading.values).*member)) : std::nullopt);
        };
        number(&BodyValues::mean, true);
        number(&BodyValues::sigma, true);
        number(&BodyValues::lo, true);
        number(&BodyValues::hi, true);
        number(&BodyValues::count, false);
        number(&BodyValues::invalid, false);
        number(&BodyValues::outside, false);
        table << lengthUnit(geometry);
        const Ruler shown = inAxes(axes, geometry, ruler);
        for (std::size_t n = 0; n < 3; ++n)
            for (int a = 0; a < 3; ++a)
                table << (n < shown.points.size() ? std::optional(shown.points[n][a]) : std::nullopt);
        table << (coordinates.empty() ? "file" : coordinates);
        table.endLine();
    }
    return table.text();
}

} // namespace pellucid
