#include "radio_transport.hpp"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <fastdds/rtps/common/LocatorsIterator.hpp>
#include <utility>

#include "rtps_header.hpp"

namespace fleetmap::bus {
namespace {

namespace transport = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;

struct RadioDescriptor final : transport::ChainingTransportDescriptor {
  RadioDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> low,
                  std::shared_ptr<RadioGuard> keys)
      : ChainingTransportDescriptor(std::move(low)), guard(std::move(keys)) {}
  transport::TransportInterface* create_transport() const override;
  std::shared_ptr<RadioGuard> guard;  ///< null without keys
};

class RadioTransport final : public transport::ChainingTransport {
 public:
  explicit RadioTransport(const RadioDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}
  transport::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(rtps::SenderResource* low, const rtps::octet* buffer, std::uint32_t size,
            rtps::LocatorsIterator* first, rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& deadline) override {
    const auto put = [&](ByteView datagram) {
      return low->send(datagram.data(), static_cast<std::uint32_t>(datagram.size()), first, last, deadline);
    };
    const ByteView whole(buffer, size), message = without_statistics(whole);
    if (descriptor_.guard) return put(descriptor_.guard->seal(message));
    return put(ends_like_statistics(message) ? whole : message);
  }
  void receive(transport::TransportReceiverInterface* next, const rtps::octet* buffer, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    if (!descriptor_.guard) return next->OnDataReceived(buffer, size, local, remote);
    const auto message = descriptor_.guard->open({buffer, size}, rtps::IPLocator::toIPv4string(remote));
    if (message)
      next->OnDataReceived(message->data(), static_cast<std::uint32_t>(message->size()), local, remote);
  }

 private:
  RadioDescriptor descriptor_;
};

transport::TransportInterface* RadioDescriptor::create_transport() const { return new RadioTransport(*this); }

}  // namespace

void prepare_transports(rtps::RTPSParticipantAttributes& attributes,
                        const std::shared_ptr<RadioGuard>& guard) {
  if (guard) std::ranges::copy(guard->session(), attributes.prefix.value);
  for (auto& transport : attributes.userTransports)
    transport = std::make_shared<RadioDescriptor>(transport, guard);
}

}  // namespace fleetmap::bus
