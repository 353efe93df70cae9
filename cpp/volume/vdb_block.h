// SPDX-License-Identifier: GPL-3.0-or-later
// Building a tree in parallel: one stack of 128^3 nodes for each 128 x 128 columns, put together at the end
// in a fixed order.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "volume/vdb.h"

namespace sightbound {

inline int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

// The nodes above one another over the columns [128 a, 128 a + 128) x [128 b, 128 b + 128).
template <class Tree>
class NodeStack {
 public:
  using Leaf = typename Tree::LeafNodeType;
  using Node4096 = typename Tree::RootNodeType::ChildNodeType;
  using Node128 = typename Node4096::ChildNodeType;
  using Value = typename Tree::ValueType;

  NodeStack() = default;
  NodeStack(int a, int b, const Value& background) : a_(a), b_(b), background_(background) {}

  void add(std::unique_ptr<Leaf> leaf) { node(leaf->origin().z()).addLeaf(leaf.release()); }
  // A tile of 8^3 that holds the voxel.
  void add_tile(const openvdb::Coord& voxel, const Value& value, bool active) {
    node(voxel.z()).addTile(1, voxel, value, active);
  }

  int a() const { return a_; }
  int b() const { return b_; }
  // By k / 128.
  std::map<int, std::unique_ptr<Node128>>& nodes() { return nodes_; }

 private:
  Node128& node(int k) {
    const int level = floor_div(k, 128);
    std::unique_ptr<Node128>& node = nodes_[level];
    if (!node)
      node = std::make_unique<Node128>(openvdb::Coord(128 * a_, 128 * b_, 128 * level), background_, false);
    return *node;
  }

  int a_ = 0, b_ = 0;
  Value background_{};
  std::map<int, std::unique_ptr<Node128>> nodes_;
};

// Moves all nodes into the tree, which has none of them yet.
template <class Tree>
void put_together(std::vector<NodeStack<Tree>>& stacks, Tree& tree) {
  using Node4096 = typename NodeStack<Tree>::Node4096;
  std::map<std::array<int, 3>, Node4096*> above;
  for (NodeStack<Tree>& stack : stacks) {
    for (auto& [level, node] : stack.nodes()) {
      const std::array<int, 3> key{floor_div(stack.a(), 32), floor_div(stack.b(), 32), floor_div(level, 32)};
      Node4096*& parent = above[key];
      if (parent == nullptr) {
        parent = new Node4096(openvdb::Coord(4096 * key[0], 4096 * key[1], 4096 * key[2]), tree.background(),
                              false);
        tree.root().addChild(parent);
      }
      parent->addChild(node.release());
    }
    stack.nodes().clear();
  }
}

}  // namespace sightbound
