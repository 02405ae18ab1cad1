// The arrays of a tree, its nodes placed for the processor's cache.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace radar {

/// Elements that a vector makes without a value stay unwritten, and take no memory of the system's until they are.
template <class Value>
struct UnwrittenAllocator : std::allocator<Value> {
  template <class Other>
  struct rebind {
    using other = UnwrittenAllocator<Other>;
  };
  template <class Other>
  void construct(Other*) {}
};
template <class Value>
using UnwrittenVector = std::vector<Value, UnwrittenAllocator<Value>>;

/// Likewise. Memory in which the pairs of siblings of a tree, of which the root comes first, are in as few cache lines
/// as they fit.
template <class Node>
struct NodeAllocator {
  using value_type = Node;
  NodeAllocator() = default;
  template <class Other>
  NodeAllocator(const NodeAllocator<Other>&) {}  // NOLINT: as allocators must

  Node* allocate(size_t count) {
    return reinterpret_cast<Node*>(static_cast<char*>(::operator new(kGap + count * sizeof(Node), kLine)) + kGap);
  }
  void deallocate(Node* nodes, size_t) { ::operator delete(reinterpret_cast<char*>(nodes) - kGap, kLine); }
  template <class Other>
  void construct(Other*) {}
  friend bool operator==(const NodeAllocator&, const NodeAllocator&) { return true; }

 private:
  static constexpr std::align_val_t kLine{64};
  static constexpr size_t kGap = size_t{64} - sizeof(Node) % 64;  // the second node begins a line
};
template <class Node>
using NodeVector = std::vector<Node, NodeAllocator<Node>>;

}  // namespace radar
