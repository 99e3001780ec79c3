// The block Cholesky of the fleet graph beside Eigen's SimplicialLLT and, where it is installed, CHOLMOD, on
// the normal equations of fleets with 500, 5,000 and 20,000 variables (poses of 6 and GPS drifts of 3
// numbers). CPU ms of one core, the best of five: symbolic analysis, numeric factorisation, one solve, and
// the covariances of all pairs of poses that share an alignment. The blocks have random values: time depends
// on the pattern alone. The second table: one 6 x 6 product of the factorisation, ns.

#include <Eigen/SparseCholesky>
#ifdef FLEETMAP_WITH_CHOLMOD
#include <Eigen/CholmodSupport>
#endif
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "fleetmap/core/cpu_time.hpp"
#include "graph/reduced_fleet.hpp"
#include "solver/block_cholesky.hpp"
#include "solver/block_kernels.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::graph;
using Sparse = Eigen::SparseMatrix<double>;
using Pairs = std::vector<std::pair<int, int>>;

constexpr int kTimes = 5;
constexpr std::size_t kSolvedPairs = 20;  // of the libraries, which solve for each pair; then scaled up

template <class Run>
double best_ms(int times, const Run& run) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < times; ++k) {
    const double start = thread_cpu_seconds();
    run();
    best = std::min(best, thread_cpu_seconds() - start);
  }
  return 1e3 * best;
}

/// The blocks of a fleet's normal equations.
struct Equations {
  std::vector<int> dims;
  Pairs pairs;       ///< that share a factor
  Pairs alignments;  ///< of these, poses
};

Equations equations_of(const graph::testing::ReducedFleet& fleet) {
  Equations equations;
  const ReducedGraph& graph = fleet.graph;
  equations.dims.assign(graph.poses.size(), 6);
  std::vector<int> drift(graph.poses.size(), -1);
  for (std::size_t p = 0; p < graph.poses.size(); ++p) {
    if (!graph.poses[p].has_window) continue;
    drift[p] = static_cast<int>(equations.dims.size());
    equations.pairs.emplace_back(static_cast<int>(p), drift[p]);
    equations.dims.push_back(3);
  }
  for (const BetweenFactor& step : graph.odometry)
    equations.pairs.emplace_back(static_cast<int>(step.a), static_cast<int>(step.b));
  for (const DriftFactor& link : graph.drift) equations.pairs.emplace_back(drift[link.a], drift[link.b]);
  for (const Alignment* a : fleet.items.alignments) {
    equations.alignments.emplace_back(static_cast<int>(graph.pose_of.at(a->i)),
                                      static_cast<int>(graph.pose_of.at(a->j)));
  }
  equations.pairs.insert(equations.pairs.end(), equations.alignments.begin(), equations.alignments.end());
  return equations;
}

/// The same numbers for all solvers: B^T B of each pair, and a multiple of the identity.
class Values {
 public:
  explicit Values(const Equations& equations) : equations_(equations) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (const auto& [i, j] : equations.pairs)
      blocks_.push_back(Eigen::MatrixXd::NullaryExpr(dim(i), dim(j), [&] { return number(random); }));
  }
  void fill(BlockCholesky& A) const {
    A.set_zero();
    for (int i = 0; i < static_cast<int>(equations_.dims.size()); ++i) {
      if (dim(i) == 6) {
        A.add<6, 6>(i, i, Matrix6d(kDiagonal * Matrix6d::Identity()));
      } else {
        A.add<3, 3>(i, i, Eigen::Matrix3d(kDiagonal * Eigen::Matrix3d::Identity()));
      }
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const auto [i, j] = equations_.pairs[k];
      if (dim(i) == 6 && dim(j) == 6) A.add<6, 6>(i, j, Matrix6d(blocks_[k]));
      if (dim(i) == 6 && dim(j) == 3) A.add<6, 3>(i, j, Eigen::Matrix<double, 6, 3>(blocks_[k]));
      if (dim(i) == 3 && dim(j) == 3) A.add<3, 3>(i, j, Eigen::Matrix3d(blocks_[k]));
    }
  }
  Sparse matrix(const BlockCholesky& A) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t e = 0; e < A.size(); ++e)
      entries.emplace_back(static_cast<int>(e), static_cast<int>(e), kDiagonal);
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const int row = static_cast<int>(A.offset(equations_.pairs[k].first));
      const int column = static_cast<int>(A.offset(equations_.pairs[k].second));
      for (int r = 0; r < blocks_[k].rows(); ++r) {
        for (int c = 0; c < blocks_[k].cols(); ++c) {
          entries.emplace_back(row + r, column + c, blocks_[k](r, c));
          entries.emplace_back(column + c, row + r, blocks_[k](r, c));
        }
      }
    }
    Sparse matrix(static_cast<Eigen::Index>(A.size()), static_cast<Eigen::Index>(A.size()));
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

 private:
  static constexpr double kDiagonal = 100.0;
  int dim(int i) const { return equations_.dims[static_cast<std::size_t>(i)]; }
  const Equations& equations_;
  std::vector<Eigen::MatrixXd> blocks_;
};

void print(std::size_t variables, const Equations& equations, const char* solver, double analysis,
           double factor, double solve, double covariances) {
  std::printf("| %zu | %zu | %s | %.1f | %.1f | %.2f | %.1f |\n", variables, equations.alignments.size(),
              solver, analysis, factor, solve, covariances);
}

Eigen::VectorXd measure_ours(const Equations& equations, const Values& values, const Eigen::VectorXd& b) {
  BlockCholesky A(equations.dims, equations.pairs);
  const double analysis = best_ms(kTimes, [&] { A = BlockCholesky(equations.dims, equations.pairs); });
  double factor = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kTimes; ++k) {
    values.fill(A);
    factor = std::min(factor, best_ms(1, [&] {
                        if (!A.factor()) std::printf("not positive definite\n");
                      }));
  }
  Eigen::VectorXd x;
  const double solve = best_ms(kTimes, [&] { x = A.solve(b); });
  std::vector<int> ends;
  for (const auto& [i, j] : equations.alignments) ends.insert(ends.end(), {i, j});
  const double covariances = best_ms(kTimes, [&] { A.invert(ends); });
  print(equations.dims.size(), equations, "block Cholesky", analysis, factor, solve, covariances);
  return x;
}

template <class Solver>
void measure_library(const char* name, const Equations& equations, const BlockCholesky& layout,
                     const Sparse& A, const Eigen::VectorXd& b, const Eigen::VectorXd& expected) {
  Solver solver;
  const double analysis = best_ms(kTimes, [&] { solver.analyzePattern(A); });
  const double factor = best_ms(kTimes, [&] { solver.factorize(A); });
  Eigen::VectorXd x;
  const double solve = best_ms(kTimes, [&] { x = solver.solve(b); });
  if (!x.isApprox(expected, 1e-6)) std::printf("%s: another solution\n", name);
  const std::size_t pairs = std::min(kSolvedPairs, equations.alignments.size());
  double sum = 0.0;
  const double some = best_ms(1, [&] {
    for (std::size_t k = 0; k < pairs; ++k) {
      Eigen::MatrixXd right = Eigen::MatrixXd::Zero(b.size(), 12);
      const auto [i, j] = equations.alignments[k];
      right.block<6, 6>(static_cast<Eigen::Index>(layout.offset(i)), 0).setIdentity();
      right.block<6, 6>(static_cast<Eigen::Index>(layout.offset(j)), 6).setIdentity();
      sum += Eigen::MatrixXd(solver.solve(right))(static_cast<Eigen::Index>(layout.offset(j)), 0);
    }
  });
  if (!std::isfinite(sum)) std::printf("%s: no covariance\n", name);
  print(equations.dims.size(), equations, name, analysis, factor, solve,
        some * static_cast<double>(equations.alignments.size()) / static_cast<double>(pairs));
}

void measure(int robots, int nodes_each, int every) {
  graph::testing::SimulatedFleet fleet(1, graph::testing::long_mission(robots, nodes_each));
  fleet.align_neighbours(every, 0.0);
  const graph::testing::ReducedFleet reduced(fleet);
  const Equations equations = equations_of(reduced);
  const Values values(equations);
  const BlockCholesky layout(equations.dims, equations.pairs);
  const Sparse A = values.matrix(layout);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(A.rows(), -1.0, 2.0);
  const Eigen::VectorXd x = measure_ours(equations, values, b);
  measure_library<Eigen::SimplicialLLT<Sparse>>("Eigen SimplicialLLT", equations, layout, A, b, x);
#ifdef FLEETMAP_WITH_CHOLMOD
  measure_library<Eigen::CholmodSimplicialLLT<Sparse>>("CHOLMOD simplicial", equations, layout, A, b, x);
  measure_library<Eigen::CholmodSupernodalLLT<Sparse>>("CHOLMOD supernodal", equations, layout, A, b, x);
#endif
}

void measure_kernels() {
  constexpr int kProducts = 1'000'000;
  Matrix6d A = Matrix6d::Random();
  const Matrix6d L = 1e-7 * Matrix6d::Random(), M = Matrix6d::Random();
  const auto ns = [&](const auto& product) {
    return best_ms(kTimes, [&] {
      for (int k = 0; k < kProducts; ++k) product();
    });
  };
  const auto with = [&](const BlockKernels& kernels) {
    return ns([&, run = kernels.subtraction(6, 6, 6)] { run(A.data(), L.data(), M.data()); });
  };
  const double processor = with(block_kernels()), any = with(plain_block_kernels());
  const double eigen = ns([&] {
    A.noalias() -= L.lazyProduct(M.transpose());
    asm volatile("" : : "r"(A.data()) : "memory");
  });
  std::printf("\n| kernel of this processor, ns | kernel of any | Eigen lazyProduct |\n|---|---|---|\n");
  std::printf("| %.1f | %.1f | %.1f |\n", processor, any, eigen);
}

}  // namespace

int main() {
  std::printf("| variables | alignments | solver | analysis, ms | factorisation | solve | covariances |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  measure(5, 270, 5);
  measure(5, 2'400, 5);
  measure(10, 4'750, 5);
  measure_kernels();
}
