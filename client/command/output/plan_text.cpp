#include "client/command/output/plan_text.h"

#include "client/command/output/table.h"

#include <nlohmann/json.hpp>

namespace alvor {

std::string table_of(std::span<const PlannedFeature> plan) {
  std::vector<std::vector<std::string>> rows{{"FEATURE", "", "WHY", "COSTS OR SAVES"}};
  for (const PlannedFeature& planned : plan)
    rows.push_back({std::string(text(planned.feature)), planned.is_on ? "on" : "off", planned.reason,
                    (planned.is_on ? "costs " : "saves ") + planned.cost});
  return aligned(rows);
}

nlohmann::ordered_json json_of(std::span<const PlannedFeature> plan) {
  auto list = nlohmann::ordered_json::array();
  for (const PlannedFeature& planned : plan)
    list.push_back(
        {{"feature", text(planned.feature)}, {"on", planned.is_on}, {"reason", planned.reason}, {"cost", planned.cost}});
  return list;
}

}  // namespace alvor
