// A page that comes from `ancf view --live` asks for more of the run, once a second.

const PAUSE = 1000;
let known = "";

async function ask() {
  const answer = await fetch(`data?known=${encodeURIComponent(known)}`, { cache: "no-store" });
  if (answer.status === 204) return;
  if (!answer.ok) throw new Error(await answer.text());
  const plain = await answer.json();
  known = plain.known;
  await renew(plain);
}

// Who opens the page while a run goes on wants to see where it is.
async function keepAsking() {
  seek(LAST);
  for (;;) {
    try {
      await ask();
      tellStatus();
    } catch (error) {
      tellStatus({ text: `no news: ${error.message}`, good: false });
    }
    await new Promise((later) => setTimeout(later, PAUSE));
  }
}

hook.follow = keepAsking;
