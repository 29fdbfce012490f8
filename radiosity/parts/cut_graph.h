#pragma once

#include <span>
#include <vector>

#include "radiosity/parts/exchange_graph.h"

namespace lightwell {

/// The largest share of exchange between two parts, relative to the area of the smaller. A door of
/// 0.9 m x 2 m in a room of 4 m x 5 m x 3 m has 1.9 %; the narrowest passage of an L-shaped room
/// about 15 %.
constexpr double most_shared_exchange = 0.05;

/// Parts the nodes of a graph where the exchange between them is small: a number from 0 for each
/// node.
///
/// - A vector that diffusion by the exchange F smooths is nearly constant within a room, and
///   differs from room to room, because light spreads within a room in a few reflections and
///   through a door in many (the slow eigenvectors of F; Shi & Malik 2000, "Normalized cuts and
///   image segmentation"). The nodes in the order of the vector's values are cut where the exchange
///   across the cut, relative to the smaller side, is least ("sweep cut"; Spielman & Teng 1996,
///   "Spectral partitioning works"), and each side is cut again.
/// - A cut holds if the exchange across is at most `most_shared_exchange` of the smaller side's
///   area and at most half of the exchange across other cuts nearby. Thus no long hall is cut,
///   which has no bottleneck.
/// - In the end parts with more than that share between them are joined, such as two halves of a
///   corridor that were cut apart with the rooms at each; and nodes that exchange more than half of
///   their light with another part than their own move there.
///
/// The work is proportional to the links, times about 50, times the number of successive cuts.
/// Vectors begin with random numbers keyed by node.
std::vector<int> cut_graph(const ExchangeGraph& graph);

/// Joins the clusters of a graph for which `joins_any` is set with the one that they exchange most
/// with; if it is empty, those with more than `most_shared_exchange` between them, the largest
/// shares first. `cluster` has numbers from 0 for each node, and gets the new ones. A cluster
/// without neighbours stays.
void join_clusters(const ExchangeGraph& graph, std::span<const char> joins_any,
                   std::vector<int>& cluster);

}  // namespace lightwell
