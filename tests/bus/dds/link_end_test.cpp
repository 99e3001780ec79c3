#include "bus/dds/link_end.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "bus/dds/inbox.hpp"

namespace fleetmap::bus {
namespace {

using ::testing::ElementsAre;

const Topic kNodes{Link::kLongRange, "node", "Node", "small"};

/// A link whose topics are in memory: the test delivers what it likes.
class MemoryLink final : public LinkEnd {
 public:
  explicit MemoryLink(std::shared_ptr<Executor> executor)
      : LinkEnd(Link::kLongRange, {}, std::move(executor)) {}

  struct Opened {
    int writers = 0, readers = 0, closed = 0;
  } opened;
  bool refuses = false;
  std::vector<Bytes> written;

  /// As if `cdr` came from the robot of that name.
  void deliver(std::uint8_t robot, Bytes cdr) {
    if (inbox_->put(std::move(cdr), {robot})) executor_->post(dispatcher(kNodes.name));
  }

 private:
  class End final : public TopicEnd {
   public:
    explicit End(MemoryLink& link) : link_(link) {}
    void open_writer() override { ++link_.opened.writers; }
    void open_reader() override { ++link_.opened.readers; }
    void close_reader() override { ++link_.opened.closed; }
    bool write(const Bytes& cdr) override {
      if (!link_.refuses) link_.written.push_back(cdr);
      return !link_.refuses;
    }
    DdsBus::Matches matches() const override { return {3, 4}; }

   private:
    MemoryLink& link_;
  };
  std::unique_ptr<TopicEnd> make(const Topic& topic, const std::shared_ptr<Inbox>& inbox) override {
    if (topic.name == "unknown") throw std::logic_error("no such profile");
    inbox_ = inbox;
    return std::make_unique<End>(*this);
  }
  std::optional<AgentId> robot_of(const Inbox::Sender& sender) const override {
    return AgentId::parse("r" + std::to_string(sender[0])).value();
  }

  std::shared_ptr<Inbox> inbox_;
};

class LinkEndTest : public ::testing::Test {
 protected:
  void run_all() {
    while (executor_->run_one(Executor::Clock::now())) continue;
  }
  TopicStats stats() const {
    std::vector<TopicStats> all;
    link_->add_stats(all);
    return all.at(0);
  }

  std::shared_ptr<Executor> executor_ = std::make_shared<Executor>();
  std::shared_ptr<MemoryLink> link_ = std::make_shared<MemoryLink>(executor_);
};

TEST_F(LinkEndTest, PublishesAndCountsWhatTheWriterRefuses) {
  link_->publish(kNodes, Bytes{1, 2});
  link_->refuses = true;
  link_->publish(kNodes, Bytes{3});
  EXPECT_THAT(link_->written, ElementsAre(Bytes{1, 2}));
  EXPECT_EQ(stats().sent_messages, 2u);
  EXPECT_EQ(stats().sent_bytes, 3u);
  EXPECT_EQ(stats().dropped_messages, 1u);
  EXPECT_EQ(stats().link, Link::kLongRange);
}

TEST_F(LinkEndTest, EachSubscriberGetsEachMessageInOrderWithItsSender) {
  std::vector<std::string> heard;
  const auto note = [&](const char* who) {
    return [&heard, who, this](const Bytes& cdr) {
      heard.push_back(who + std::to_string(cdr.at(0)) + link_->sender()->str());
    };
  };
  const Handle one = link_->subscribe(kNodes, note("a")), other = link_->subscribe(kNodes, note("b"));
  link_->deliver(1, {7});
  link_->deliver(2, {8});
  EXPECT_TRUE(heard.empty()) << "only on the callback thread";
  run_all();
  EXPECT_THAT(heard, ElementsAre("a7r1", "b7r1", "a8r2", "b8r2"));
  EXPECT_FALSE(link_->sender()) << "nothing is being dispatched";
  EXPECT_EQ(stats().received_messages, 2u);
}

TEST_F(LinkEndTest, TheReaderClosesWithTheLastSubscriber) {
  int heard = 0;
  {
    const Handle one = link_->subscribe(kNodes, [&](const Bytes&) { ++heard; });
    {
      const Handle other = link_->subscribe(kNodes, [&](const Bytes&) { ++heard; });
    }
    EXPECT_EQ(link_->opened.closed, 0);
    link_->deliver(1, {7});
  }
  EXPECT_EQ(link_->opened.closed, 1);
  run_all();
  EXPECT_EQ(heard, 0) << "a message that waits reaches nobody who has left";
}

TEST_F(LinkEndTest, ACallbackMayCancelAnotherSubscription) {
  int heard = 0;
  std::optional<Handle> second;
  const Handle first = link_->subscribe(kNodes, [&](const Bytes&) { second.reset(); });
  second = link_->subscribe(kNodes, [&](const Bytes&) { ++heard; });
  link_->deliver(1, {7});
  run_all();
  EXPECT_EQ(heard, 0);
}

TEST_F(LinkEndTest, ATopicHasOneTypeAndProfile) {
  link_->advertise(kNodes);
  EXPECT_EQ(link_->opened.writers, 1);
  Topic other = kNodes;
  other.type = "Alignment";
  EXPECT_THROW(link_->publish(other, {}), std::logic_error);
  other = kNodes;
  other.profile = "bulk";
  EXPECT_THROW(static_cast<void>(link_->subscribe(other, [](const Bytes&) {})), std::logic_error);
}

TEST_F(LinkEndTest, AnUnknownTopicMatchesNobodyAndLeavesNothing) {
  Topic unknown = kNodes;
  unknown.name = "unknown";
  EXPECT_EQ(link_->matches(kNodes).writers, 0u);
  EXPECT_THROW(link_->advertise(unknown), std::logic_error);
  std::vector<TopicStats> all;
  link_->add_stats(all);
  EXPECT_TRUE(all.empty());
}

TEST_F(LinkEndTest, AHandleMayOutliveTheLink) {
  int heard = 0;
  Handle handle = link_->subscribe(kNodes, [&](const Bytes&) { ++heard; });
  link_->deliver(1, {7});
  link_.reset();
  run_all();
  handle = {};
  EXPECT_EQ(heard, 0);
}

}  // namespace
}  // namespace fleetmap::bus
