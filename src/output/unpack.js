// The data and scripts of this page stand compressed in it: they are unpacked, and the scripts run in their order.
"use strict";
addEventListener("DOMContentLoaded", async () => {
  for (const packed of document.querySelectorAll("script[type='text/packed']")) {
    const bytes = Uint8Array.from(atob(packed.textContent), c => c.charCodeAt(0)), script = document.createElement("script");
    if (packed.id) script.id = packed.id, script.type = "application/json";
    script.textContent = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).text();
    packed.replaceWith(script);
  }
});
