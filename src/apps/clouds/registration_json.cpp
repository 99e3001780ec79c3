#include "registration_json.hpp"

#include "fleetmap/registration/registration_method.hpp"

namespace fleetmap::apps {
namespace {

template <class Matrix>
nlohmann::json matrix_rows(const Matrix& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    nlohmann::json row = nlohmann::json::array();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

nlohmann::json to_json(const registration::RegistrationResult& result, registration::Method method) {
  nlohmann::json modes = nlohmann::json::array();
  for (const registration::Mode& mode : result.modes) {
    modes.push_back({{"T_target_source", matrix_rows(mode.T_target_source.matrix())},
                     {"score", mode.score},
                     {"rmse", mode.rmse},
                     {"inlier_fraction", mode.inlier_fraction},
                     {"overlap", mode.overlap},
                     {"weight", mode.weight}});
  }
  return {{"method", registration::to_string(method)},
          {"verdict", registration::to_string(result.verdict)},
          {"reason", result.reason},
          {"T_target_source", matrix_rows(result.T_target_source.matrix())},
          {"rmse", result.rmse},
          {"covariance", matrix_rows(result.covariance)},
          {"inlier_fraction", result.inlier_fraction},
          {"overlap", result.overlap},
          {"inliers", result.inliers},
          {"modes", modes}};
}

}  // namespace fleetmap::apps
