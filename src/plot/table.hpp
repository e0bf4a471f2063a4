#pragma once

#include "plot/plot.hpp"
#include "plot/style.hpp"

namespace doppel {

/// The size of text at which the table fits into `area`, px an em.
float fitting_table_size(const PlotTable& table, const Area& area, const PlotStyle& style);

/// The table in `area`, words shrunk until all of it fits.
void draw_table(const PlotTable& table, const Area& area, const PlotStyle& style, DisplayList& list);

}  // namespace doppel
