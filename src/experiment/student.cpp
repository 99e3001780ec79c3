#include "student.hpp"

#include <boost/math/distributions/students_t.hpp>

namespace fleetmap::experiment {
namespace {

namespace policies = boost::math::policies;
/// NaN where Boost's default would throw: a curve of one seed has no error.
using Student =
    boost::math::students_t_distribution<double,
                                         policies::policy<policies::domain_error<policies::ignore_error>>>;

}  // namespace

double student_tail(double t, double freedom) {
  return boost::math::cdf(boost::math::complement(Student(freedom), t));
}

double student_quantile(double tail, double freedom) {
  return boost::math::quantile(boost::math::complement(Student(freedom), tail));
}

}  // namespace fleetmap::experiment
