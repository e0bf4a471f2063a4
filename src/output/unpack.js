// The data and scripts of this page stand compressed in it: they are unpacked, and the scripts run in their order.
"use strict";
const inflated = base64 => new Response(new Blob([Uint8Array.from(atob(base64), c => c.charCodeAt(0))]).stream()
  .pipeThrough(new DecompressionStream("deflate")));
addEventListener("DOMContentLoaded", async () => {
  for (const packed of document.querySelectorAll("script[type='text/packed']")) {
    const script = document.createElement("script");
    if (packed.id) script.id = packed.id, script.type = "application/json";
    script.textContent = await inflated(packed.textContent).text();
    packed.replaceWith(script);
  }
});
