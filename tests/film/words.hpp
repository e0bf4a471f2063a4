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

inline std::vector<Label> labels_in(const std::vector<DisplayList>& lists) {
    std::vector<Label> labels;
    for (const auto& list : lists)
        for (const auto& item : list)
            if (const auto* label = std::get_if<Label>(&item); label && !label->text.empty()) labels.push_back(*label);
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
    return std::any_of(list.begin(), list.end(), [&](const auto& item) {
        const auto* label = std::get_if<Label>(&item);
        return label && label->text.find(words) != std::string::npos;
    });
}

}  // namespace doppel
