#pragma once

#include "film/support.hpp"
#include "render/typeface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace doppel {

/// The area of a label, px: letters of DejaVu Sans rise 0.73 em above the baseline and descend 0.24 em below it.
inline Area box_of(const Label& label, const Typeface& type = {}) {
    const float width = type.width(label.text, label.size, label.weight);
    const float share = label.align == Align::left ? 0 : label.align == Align::center ? 0.5f : 1;
    const float left = label.anchor.x - share * width;
    return {left, label.anchor.y - 0.73f * label.size, left + width, label.anchor.y + 0.24f * label.size};
}

/// The items of a kind that pass the test, in order.
template <class Kind, class Test>
std::vector<Kind> items_in(const DisplayList& list, Test&& passes) {
    std::vector<Kind> items;
    for (const auto& item : list)
        if (const auto* one = std::get_if<Kind>(&item); one && passes(*one)) items.push_back(*one);
    return items;
}
template <class Kind>
std::vector<Kind> items_in(const DisplayList& list) {
    return items_in<Kind>(list, [](const Kind&) { return true; });
}

inline std::vector<Label> labels_in(const std::vector<DisplayList>& lists) {
    std::vector<Label> labels;
    for (const auto& list : lists)
        std::ranges::move(items_in<Label>(list, [](const Label& one) { return !one.text.empty(); }),
                          std::back_inserter(labels));
    return labels;
}

inline std::vector<std::string> words_of(const std::vector<DisplayList>& lists) {
    std::vector<std::string> words;
    for (const auto& label : labels_in(lists)) words.push_back(label.text);
    return words;
}

/// The labels of the picture after the snapshots 0 … last.
inline std::vector<Label> labels_of(const Scene& scene, long last) {
    const auto composer = composed(scene, last);
    return labels_in({composer->backdrop(), composer->frame()});
}

/// Each label is inside the picture, and no two overlap.
inline void expect_apart(const std::vector<Label>& labels, Size size, const std::string& what,
                         const Typeface& type = {}) {
    const Area picture{0, 0, static_cast<float>(size.width), static_cast<float>(size.height)};
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const auto box = box_of(labels[i], type);
        EXPECT_TRUE(picture.contains(box)) << what << ": " << labels[i].text;
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_FALSE(box.overlaps(box_of(labels[j], type)))
                << what << ": " << labels[i].text << " | " << labels[j].text;
    }
}

inline bool says(const DisplayList& list, const std::string& words) {
    return !items_in<Label>(list, [&](const Label& one) { return one.text.find(words) != std::string::npos; }).empty();
}

}  // namespace doppel
