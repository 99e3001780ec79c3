// `fleetmap hold`, `resume`, `home` and `give`: an operator's order to one robot or to all, over the long
// range.
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "operator_order.hpp"
#include "validators.hpp"

namespace fleetmap::apps {
namespace {

CLI::App* add_order(CLI::App& app, const char* name, const char* about,
                    const std::shared_ptr<OrderOptions>& options) {
  CLI::App* command = app.add_subcommand(name, about);
  command->add_option("-c,--config", options->config, "AGENT.yaml of any robot, or FLEET.yaml")->required();
  command->add_option("--robot", options->robot, "applies to this robot alone")->check(some_path());
  command->add_option("--timeout", options->timeout, "s, time to wait for the confirmation of every robot")
      ->check(positive_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  return command;
}

}  // namespace

void add_hold(CLI::App& app, int& exit_code) {
  using Kind = messages::HoldOrder::Kind;
  const auto add = [&](const char* name, const char* about, Kind kind) {
    const auto options = std::make_shared<OrderOptions>();
    add_order(app, name, about, options)->callback([options, kind, &exit_code] {
      exit_code = report(order_driving(*options, kind, std::cout));
    });
  };
  add("hold", "orders one robot or all to stop until resume, over the long range", Kind::kHold);
  add("resume", "orders one robot or all to go on: held ones as before, those called home with their rows",
      Kind::kResume);
  add("home", "orders one robot or all to give their rows away and drive to their starts until resume",
      Kind::kHome);
  const auto options = std::make_shared<OrderOptions>();
  CLI::App* command = add_order(app, "give", "gives a row of a robot to another one", options);
  command->get_option("--robot")->required()->description("the robot that is not to drive the row");
  command->add_option("--row", options->row, "id of the row, as the mission's file has it")->required();
  command->add_option("--to", options->to, "the robot that is to drive it; else any other one")
      ->check(some_path());
  command->callback([options, &exit_code] { exit_code = report(order_row(*options, std::cout)); });
}

}  // namespace fleetmap::apps
