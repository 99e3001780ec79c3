#include "fleetmap/odometry/loam.hpp"

#include <utility>

#include "loam_pipeline.hpp"

namespace fleetmap::odometry {

Loam::Loam(LoamConfig config, LidarModel model)
    : pipeline_(std::make_unique<LoamPipeline>(std::move(config), model)) {}
Loam::~Loam() = default;
Loam::Loam(Loam&&) noexcept = default;
Loam& Loam::operator=(Loam&&) noexcept = default;

void Loam::set_imu_rotation(const Eigen::Quaterniond& q_base_imu) { pipeline_->set_imu_rotation(q_base_imu); }
void Loam::add_imu(const sensor::Imu& imu) { pipeline_->add_imu(imu); }
void Loam::add_wheel(const sensor::Wheel& wheel) { pipeline_->add_wheel(wheel); }
Result<OdometryUpdate> Loam::add_scan(const sensor::Scan& scan) { return pipeline_->add_scan(scan); }
std::vector<std::string> Loam::take_warnings() { return pipeline_->take_warnings(); }
const LoamCounters& Loam::counters() const { return pipeline_->counters(); }
LocalMapSize Loam::map_size() const { return pipeline_->map_size(); }

}  // namespace fleetmap::odometry
