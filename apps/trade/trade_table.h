#pragma once

#include "apps/reproduce/result_table.h"
#include "apps/trade/trade.h"

namespace spume::apps {

/// Every figure of every run as rows of a table: the reference's figure beside it, and as its aim the band of
/// the scene's own runs, met or missed. Times and iterations are reported.
ResultTable tradeTable(const Trade& trade);

}  // namespace spume::apps
