// A file of DDS profiles. The first byte chooses the link that it is for.
#include <fastdds/dds/log/Log.hpp>

#include "bus/dds/qos_file.hpp"
#include "checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  eprosima::fastdds::dds::Log::ClearConsumers();  // each refusal would be printed
  static const fuzz::Folder folder;
  const fuzz::Input input = fuzz::split(data, size);
  const auto link = static_cast<bus::Link>(input.choice % 3);
  const auto path = folder.write(std::string(bus::to_string(link)) + ".xml", input.rest);
  const auto file = bus::load_qos_file(folder.path(), link);
  if (!file)
    fuzz::require(file.error().message.starts_with(path.string()), "the error does not name the file");
  return 0;
}
