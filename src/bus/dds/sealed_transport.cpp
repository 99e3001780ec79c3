#include "sealed_transport.hpp"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <fastdds/rtps/common/LocatorsIterator.hpp>
#include <utility>

namespace fleetmap::bus {
namespace {

namespace dds = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;

struct SealedDescriptor final : dds::ChainingTransportDescriptor {
  SealedDescriptor(std::shared_ptr<dds::TransportDescriptorInterface> low, std::shared_ptr<RadioGuard> keys)
      : ChainingTransportDescriptor(std::move(low)), guard(std::move(keys)) {}
  dds::TransportInterface* create_transport() const override;
  std::shared_ptr<RadioGuard> guard;
};

class SealedTransport final : public dds::ChainingTransport {
 public:
  explicit SealedTransport(const SealedDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}
  dds::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(rtps::SenderResource* low, const rtps::octet* buffer, std::uint32_t size,
            rtps::LocatorsIterator* first, rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& deadline) override {
    const Bytes datagram = descriptor_.guard->seal({buffer, size});
    return low->send(datagram.data(), static_cast<std::uint32_t>(datagram.size()), first, last, deadline);
  }
  void receive(dds::TransportReceiverInterface* next, const rtps::octet* buffer, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    const auto message = descriptor_.guard->open({buffer, size}, rtps::IPLocator::toIPv4string(remote));
    if (message)
      next->OnDataReceived(message->data(), static_cast<std::uint32_t>(message->size()), local, remote);
  }

 private:
  SealedDescriptor descriptor_;
};

dds::TransportInterface* SealedDescriptor::create_transport() const { return new SealedTransport(*this); }

}  // namespace

void seal_transports(rtps::RTPSParticipantAttributes& attributes, const std::shared_ptr<RadioGuard>& guard) {
  std::ranges::copy(guard->session(), attributes.prefix.value);
  for (auto& transport : attributes.userTransports)
    transport = std::make_shared<SealedDescriptor>(transport, guard);
}

}  // namespace fleetmap::bus
