"use strict";
// Values along an axis of a figure: from its start, 0, to its end, 1.
const axisValue = ({ from, to, logarithmic }, share) => logarithmic ? from * (to / from) ** share : from + (to - from) * share;
const axisShare = ({ from, to, logarithmic }, value) => logarithmic ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
const written = value => String(value).replace("-", "−");
