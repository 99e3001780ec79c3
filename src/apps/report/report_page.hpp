#pragma once

#include "fleetmap/eval/html_page.hpp"
#include "report_facts.hpp"

namespace fleetmap::apps {

/// report.html: a run for the people who drove it, warnings first.
eval::HtmlPage report_page(const ReportFacts& facts);

}  // namespace fleetmap::apps
