// The files of a robot from which `fleetmap trial` computes its metrics. The first byte chooses which one.
#include <array>
#include <cmath>

#include "checks.hpp"
#include "experiment/field_measures.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  struct File {
    const char* name;
    const char* valid;
  };
  constexpr std::array kFiles{
      File{"r1/link_trace.csv", "time_s,link,from,to,kbit_s,ms,loss_percent,used_kbit_s,messages\n"},
      File{"r1/node_times.csv", "time_ns,node\n1000000000,r1#7/0\n"},
      File{"r1/report.json", "{\"topics\": []}"}, File{"field.json", "{\"all_know_s\": 0.5}"}};
  const fuzz::Input input = fuzz::split(data, size);
  for (std::size_t k = 0; k < kFiles.size(); ++k) {
    const std::string_view valid = kFiles[k].valid;
    folder.write(kFiles[k].name, k == input.choice % kFiles.size() ? fuzz::text_of(input.rest) : valid);
  }
  const auto measures = experiment::field_measures(folder.path());
  if (!measures) {
    fuzz::require(!measures.error().message.empty(), "refused without a reason");
    return 0;
  }
  for (const auto& [name, value] : *measures) {
    fuzz::require(name.starts_with("field."), "a metric of another group");
    fuzz::require(!std::isnan(value), "a metric is no number");
  }
  return 0;
}
