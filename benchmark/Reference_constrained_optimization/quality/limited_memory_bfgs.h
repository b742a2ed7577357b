#pragma once

// Minimizes a function by the limited-memory BFGS method with backtracking.

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <numeric>
#include <vector>

// a plain sum: gcc 12 takes Eigen's for AVX-512 to read what was not set
inline double inner_product(const Eigen::VectorXd& a, const Eigen::VectorXd& b)
{
  return std::inner_product(a.data(), a.data() + a.size(), b.data(), 0.);
}

inline double largest_entry(const Eigen::VectorXd& a)
{
  double largest = 1e-300; // never zero
  for(const double x : a)
    largest = (std::max)(largest, std::abs(x));
  return largest;
}

// the last steps and how the gradient changed along them, and the product with the inverse Hessian
// that they stand for
class Secant_memory
{
public:
  void add(const Eigen::VectorXd& step, const Eigen::VectorXd& change)
  {
    const double curvature = inner_product(step, change);
    if(!(curvature * curvature >
         1e-24 * inner_product(step, step) * inner_product(change, change)) ||
       curvature <= 0)
      return;
    m_pairs.push_back({step, change, curvature});
    const std::size_t most_pairs = 10;
    if(m_pairs.size() > most_pairs)
      m_pairs.pop_front();
  }

  bool empty() const { return m_pairs.empty(); }
  void clear() { m_pairs.clear(); }

  Eigen::VectorXd apply(Eigen::VectorXd x) const
  {
    std::vector<double> factors(m_pairs.size());
    for(std::size_t i = m_pairs.size(); i-- > 0;)
    {
      factors[i] = inner_product(m_pairs[i].step, x) / m_pairs[i].curvature;
      x -= factors[i] * m_pairs[i].change;
    }
    if(!m_pairs.empty())
      x *= m_pairs.back().curvature / inner_product(m_pairs.back().change, m_pairs.back().change);
    for(std::size_t i = 0; i < m_pairs.size(); ++i)
      x +=
        (factors[i] - inner_product(m_pairs[i].change, x) / m_pairs[i].curvature) * m_pairs[i].step;
    return x;
  }

private:
  struct Pair
  {
    Eigen::VectorXd step, change;
    double curvature; // their product
  };

  std::deque<Pair> m_pairs;
};

// `function(x, gradient)` returns the value; infinity for an x that must not be gone to. The first
// step has length `first_step` in its largest entry. Returns the number of iterations.
template <typename Function>
int minimize(const Function& function,
             Eigen::VectorXd& x,
             double first_step,
             int most_iterations,
             double tolerance)
{
  Secant_memory memory;
  Eigen::VectorXd gradient(x.size()), new_gradient(x.size());
  double value = function(x, gradient);
  for(int i = 0; i < most_iterations; ++i)
  {
    Eigen::VectorXd direction = -memory.apply(gradient);
    if(memory.empty())
      direction *= first_step / largest_entry(direction);
    const double slope = inner_product(direction, gradient);
    if(!(slope < 0))
      return i;
    const int most_halvings = 30;
    Eigen::VectorXd step;
    double new_value = value;
    bool falls = false;
    for(int k = 0; k < most_halvings && !falls; ++k)
    {
      step = std::ldexp(1., -k) * direction;
      new_value = function(x + step, new_gradient);
      falls = std::isfinite(new_value) && new_value <= value + 1e-4 * std::ldexp(slope, -k);
    }
    if(!falls && memory.empty())
      return i;
    if(!falls)
    {
      memory.clear();
      continue;
    }
    x += step;
    memory.add(step, new_gradient - gradient);
    gradient = new_gradient;
    const bool is_done = value - new_value < tolerance * std::abs(value);
    value = new_value;
    if(is_done)
      return i + 1;
  }
  return most_iterations;
}
