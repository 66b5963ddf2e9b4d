// SPDX-License-Identifier: MIT
#include "diagnostics/reading/given_values.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::diagnostics {

using document::Node;

const Node* find(const Node& root, std::initializer_list<const char*> keys) {
  const Node* at = &root;
  for (const char* key : keys) {
    at = at->isMap() ? at->find(key) : nullptr;
    if (at == nullptr) return nullptr;
  }
  return at;
}

std::vector<double> numbersIn(const Node* list) {
  std::vector<double> numbers;
  if (list == nullptr) return numbers;
  if (list->isScalar()) numbers.push_back(document::toNumber(list->scalar).value_or(0));
  for (const Node& item : list->items)
    for (const double number : numbersIn(&item)) numbers.push_back(number);
  return numbers;
}

std::vector<double> numbersOf(const Node* list, size_t count) {
  std::vector<double> numbers;
  if (list == nullptr || list->items.size() != count) return numbers;
  for (const Node& item : list->items) numbers.push_back(document::toNumber(item.scalar).value_or(0));
  return numbers;
}

double largest(const std::vector<double>& numbers) {
  double most = 0;
  for (const double number : numbers) most = std::max(most, std::abs(number));
  return most;
}

}  // namespace hapticd::diagnostics
