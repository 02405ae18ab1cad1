// Large arrays, which searches read here and there, and the nodes of trees, placed for the processor's caches.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace radar {

/// Asks for huge pages, of which the processor's cache of addresses covers more.
void adviseHugePages(void* memory, size_t bytes);

/// Memory in huge pages, where an array is large enough.
template <class Value>
struct LargeAllocator : std::allocator<Value> {
  template <class Other>
  struct rebind {
    using other = LargeAllocator<Other>;
  };
  Value* allocate(size_t count) {
    Value* const memory = std::allocator<Value>::allocate(count);
    adviseHugePages(memory, count * sizeof(Value));
    return memory;
  }
};
template <class Value>
using LargeVector = std::vector<Value, LargeAllocator<Value>>;

/// Likewise. Elements that a vector makes without a value stay unwritten, and take no memory of the system's until they
/// are.
template <class Value>
struct UnwrittenAllocator : LargeAllocator<Value> {
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
    const size_t bytes = kGap + count * sizeof(Node);
    void* const memory = ::operator new(bytes, kLine);
    adviseHugePages(memory, bytes);
    return reinterpret_cast<Node*>(static_cast<char*>(memory) + kGap);
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
