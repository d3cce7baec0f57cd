#include "bakerd/worker/changes_since.h"

#include <fmt/format.h>

namespace drtv::worker {

ChangesSince::ChangesSince(std::shared_ptr<const reuse::Inventory> inventory, store::BlobStore& store)
    : inventory_(std::move(inventory)), store_(store) {}

tl::expected<ChangesSince::Changes, std::string> ChangesSince::map(const Digest& inventory) {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(inventory); found != known_.end())
        return found->second;
    const auto unusable = [](std::string_view why) {
        return tl::unexpected(fmt::format("the record of an earlier map cannot be used: {}", why));
    };
    const auto bytes = store_.get(inventory);
    if (!bytes)
        return unusable(bytes.error().message);
    const auto before = reuse::decode_inventory(*bytes);
    if (!before)
        return unusable("it is not one");
    auto changes =
        std::make_shared<const std::vector<reuse::Change>>(reuse::changes_between(*before, *inventory_));
    known_[inventory] = changes;
    return changes;
}

}  // namespace drtv::worker
